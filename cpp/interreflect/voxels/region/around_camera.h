#pragma once
#include "data/technique.h"

namespace interreflect {

/// A cube about the camera, which moves with it in steps.
struct AroundCamera {
    double width = 1.0;
    int step = 1;

    bool operator==(const AroundCamera&) const = default;
    static constexpr auto description =
        describe("AroundCamera", "A cube about the camera, which moves with it in steps.", Source{"Freed 2018", "4.1"},
                 Param{"width", &AroundCamera::width, "edge of the cube", Unit::extents, above_up_to(0, 100)},
                 Param{"step", &AroundCamera::step,
                       "the cube moves by whole multiples of this: 2^n keeps the voxels of n levels above the finest where they "
                       "are; 0: with "
                       "the camera, so that every voxel flickers",
                       Unit::voxels, between(0, 64)});
};

}  // namespace interreflect
