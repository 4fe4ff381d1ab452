#pragma once
#include "data/technique.h"
#include "virtual_lights/filter/shadowed_light.h"

namespace interreflect {

/// The share of lookups about the pixel's place in the map that are lit.
struct Pcf {
    int samples = 16;
    double radius = 2.0;

    bool operator==(const Pcf&) const = default;
    static constexpr auto description =
        describe("Pcf", "The share of several lookups, a fixed disk of texels, that are lit.",
                 Source{"Reeves et al. 1987", "percentage-closer filtering"},
                 Param{"samples", &Pcf::samples, "lookups, over a Poisson disk", Unit::samples, between(1, 64)},
                 Param{"radius", &Pcf::radius, "of the disk, in texels of a light's map", Unit::texels, at_least(0)});
};
void visibility(const Pcf& technique, const ShadowedLight& light, const Receivers& receivers, const PerReceiver& irradiance,
                std::uint32_t seed, PerReceiver& visible, Counts& counts);

}  // namespace interreflect
