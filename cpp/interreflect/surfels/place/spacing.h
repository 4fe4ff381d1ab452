/// How evenly do surfels lie?
#pragma once
#include "data/surfels.h"

namespace interreflect {

/// The distance of every surfel to the nearest other one on the same side, over the root of its area; infinite where there is
/// none. Points of a plane at random: mean 0.5, standard deviation over the mean 0.523, fifth percentile 0.128 [Clark and Evans
/// 1954]. Blue noise: none below 0.835, since disks dropped at random where they fit fill 0.547 of the plane [Hinrichsen et al.
/// 1986]. The densest packing: all 1.075.
Buffer<float> surfel_spacing(const Surfels& surfels);

}  // namespace interreflect
