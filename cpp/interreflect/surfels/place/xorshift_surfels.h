#pragma once
#include "data/scene.h"
#include "data/surfels.h"
#include "data/technique.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Points of a random number generator on each triangle, as many as its area asks for [Marsaglia 2003].
struct XorshiftSurfels {
    int surfels = 32768;

    bool operator==(const XorshiftSurfels&) const = default;
    static constexpr auto description = describe(
        "XorshiftSurfels", "Random points on every triangle.", Source{"Jendersie et al. 2016", "4.2"},
        Param{"surfels", &XorshiftSurfels::surfels, "how many, on all of the still surface", Unit::none, between(1, 1 << 22)});
};

Surfels place_surfels(const XorshiftSurfels& technique, const Scene& scene, const Intersector& intersector);

}  // namespace interreflect
