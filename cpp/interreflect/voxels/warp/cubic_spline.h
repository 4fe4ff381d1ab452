#pragma once
#include "data/technique.h"

namespace interreflect {

/// Along each axis the cubic w(x) = a x + (3 - 3 a) x^2 + (2 a - 2) x^3 about the camera: slope a at the region's ends, and at
/// the camera 1.5 - a / 2.
struct CubicSpline {
    double alpha = 0.25;

    bool operator==(const CubicSpline&) const = default;
    static constexpr auto description =
        describe("CubicSpline", "Along each axis a cubic about the camera whose slope at the region's ends is `alpha`.",
                 Source{"Freed 2018", "4.6.1"},
                 Param{"alpha", &CubicSpline::alpha,
                       "voxels at the region's ends as a multiple of evenly spread ones; at the camera 1.5 - alpha / 2",
                       Unit::none, between(0, 3)});
};

}  // namespace interreflect
