#pragma once
#include "data/scene.h"
#include "data/surfels.h"
#include "data/technique.h"
#include "visibility/intersector.h"

namespace interreflect {

/// HaltonSurfels that push their neighbours away along the surface, over and over. The article does not say how hard.
struct RelaxedSurfels {
    int surfels = 32768;
    int iterations = 16;

    bool operator==(const RelaxedSurfels&) const = default;
    static constexpr auto description = describe(
        "RelaxedSurfels", "Halton's points that push their neighbours away along the surface.",
        Source{"Jendersie et al. 2016", "4.2"},
        Param{"surfels", &RelaxedSurfels::surfels, "how many, on all of the still surface", Unit::none, between(1, 1 << 22)},
        Param{"iterations", &RelaxedSurfels::iterations, "times that all move", Unit::none, between(0, 1024)});
};

Surfels place_surfels(const RelaxedSurfels& technique, const Scene& scene, const Intersector& intersector);

}  // namespace interreflect
