/// Points of the unit disk that keep their distance [Bridson 2007; here by Mitchell's best candidate, 1991]: the first n of them
/// are spread about as evenly for every n.
#pragma once
#include <array>

#include "math/vectors.h"

namespace interreflect {

inline constexpr int most_disk_points = 64;
const std::array<vec2, most_disk_points>& poisson_disk();

}  // namespace interreflect
