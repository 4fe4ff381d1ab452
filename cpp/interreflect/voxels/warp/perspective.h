#pragma once
#include "voxels/warp/view_volume.h"

namespace interreflect {

/// The view frustum as the picture's projection maps it onto the unit cube.
struct Perspective : ViewVolume {
    bool linear_depth = true;

    bool operator==(const Perspective&) const = default;
    static constexpr auto description =
        describe("Perspective", "The view frustum as the picture's projection maps it onto the grid.",
                 Source{"Freed 2018", "4.6.2"}, ViewVolume::params,
                 Param{"linear_depth", &Perspective::linear_depth,
                       "slices of equal depth; else hyperbolic (not logarithmic: ERRATA), as a projection matrix leaves it"});
};

}  // namespace interreflect
