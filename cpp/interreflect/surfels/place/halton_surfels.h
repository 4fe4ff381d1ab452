#pragma once
#include "data/scene.h"
#include "data/surfels.h"
#include "data/technique.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Points of Halton's sequence on each triangle, as many as its area asks for [Halton 1964].
struct HaltonSurfels {
    int surfels = 32768;

    bool operator==(const HaltonSurfels&) const = default;
    static constexpr auto description = describe(
        "HaltonSurfels", "Points of Halton's sequence on every triangle.", Source{"Jendersie et al. 2016", "4.2"},
        Param{"surfels", &HaltonSurfels::surfels, "how many, on all of the still surface", Unit::none, between(1, 1 << 22)});
};

Surfels place_surfels(const HaltonSurfels& technique, const Scene& scene, const Intersector& intersector);

}  // namespace interreflect
