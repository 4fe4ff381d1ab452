#pragma once
#include "data/technique.h"

namespace interreflect {

/// Along each axis a logistic curve about the camera, shifted and scaled so that it maps the region onto itself (as printed,
/// 1 / (1 + e^-x) maps [0, 1] to [.5, .731]: ERRATA).
struct Logistic {
    double steepness = 6.0;

    bool operator==(const Logistic&) const = default;
    static constexpr auto description =
        describe("Logistic", "Along each axis a logistic curve about the camera, which leaves few voxels for the region's ends.",
                 Source{"Freed 2018", "4.6.1"},
                 Param{"steepness", &Logistic::steepness,
                       "k of 1 / (1 + e^(-k x)), x in [-1/2, 1/2] over the region: 6 has 1.66 times the voxels at the camera, "
                       ".30 at the ends",
                       Unit::none, above_up_to(0, 40)});
};

}  // namespace interreflect
