#pragma once
#include "data/technique.h"
#include "virtual_lights/filter/shadowed_light.h"

namespace interreflect {

/// Rays to points of the light's disk, spread anew for every pixel, light and seed: an unbiased estimate of the share that is
/// seen.
struct TracedDisk {
    int samples = 4;

    bool operator==(const TracedDisk&) const = default;
    static constexpr auto description =
        describe("TracedDisk", "The share of a light's disk that rays reach.", Source{"Cook et al. 1984"},
                 Param{"samples", &TracedDisk::samples, "rays to each light", Unit::samples, between(1, 4096)});
};
void visibility(const TracedDisk& technique, const ShadowedLight& light, const Receivers& receivers,
                const PerReceiver& irradiance, std::uint32_t seed, PerReceiver& visible, Counts& counts);

}  // namespace interreflect
