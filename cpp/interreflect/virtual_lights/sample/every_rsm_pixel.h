#pragma once
#include "data/technique.h"
#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

/// Every texel that sends light on is a light; or so many of them, chosen anew by every seed in proportion to what they send on:
/// an unbiased estimate of all.
struct EveryRsmPixel {
    int samples = 1024;

    bool operator==(const EveryRsmPixel&) const = default;
    static constexpr auto description = describe(
        "EveryRsmPixel", "Every texel of the reflective shadow maps is a light, or so many chosen at random by their flux.",
        Source{"Dachsbacher and Stamminger 2005"},
        Param{"samples", &EveryRsmPixel::samples, "lights chosen at random; 0: every texel", Unit::samples, between(0, 1 << 20)});
};

VirtualLights sample_lights(const EveryRsmPixel& technique, const LightMaps& maps, std::uint32_t seed);

}  // namespace interreflect
