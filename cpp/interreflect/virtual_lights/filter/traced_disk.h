#pragma once
#include "data/technique.h"
#include "virtual_lights/filter/shadowed_light.h"

namespace interreflect {

/// Rays to a light's members, each as often as it would bring light to the pixel, spread anew for every pixel, light and seed: an
/// unbiased estimate of the share that is seen. A cluster's flat disk reaches past edges of what its members lie on, where it is
/// hidden while they are not. A light that stands for one texel, or that a user placed, is its disk.
struct TracedDisk {
    int samples = 4;

    bool operator==(const TracedDisk&) const = default;
    static constexpr auto description =
        describe("TracedDisk", "The share of a light's members, or of its disk, that rays reach.", Source{"Cook et al. 1984"},
                 Param{"samples", &TracedDisk::samples, "rays to each light", Unit::samples, between(1, 4096)});
};
void visibility(const TracedDisk& technique, const ShadowedLight& light, const Receivers& receivers,
                const PerReceiver& irradiance, std::uint32_t seed, PerReceiver& visible, Counts& counts);

}  // namespace interreflect
