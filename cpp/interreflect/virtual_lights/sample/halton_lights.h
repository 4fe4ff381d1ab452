#pragma once
#include <string>

#include "data/technique.h"
#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

/// Points of Halton's sequence, warped to where texels matter; the same in every frame. A light's flux is the texel's over the
/// density of its choice.
struct HaltonLights {
    int lights = 128;
    std::string importance = "flux";

    bool operator==(const HaltonLights&) const = default;
    static constexpr auto description =
        describe("HaltonLights", "Points of Halton's sequence, warped by the texels' importance.",
                 Source{"Weinzierl-Heigl 2013; Clarberg et al. 2005", "4, initialization; hierarchical sample warping"},
                 Param{"lights", &HaltonLights::lights, "how many", Unit::none, between(0, 1 << 16)},
                 Param{"importance", &HaltonLights::importance,
                       "by what points are drawn: the flux sent on, the specular reflectance as in the paper (a tenth by flux, "
                       "so that none is "
                       "left out), or none",
                       Unit::none, one_of("flux|specular|none")});
};

VirtualLights sample_lights(const HaltonLights& technique, const LightMaps& maps, std::uint32_t seed);

}  // namespace interreflect
