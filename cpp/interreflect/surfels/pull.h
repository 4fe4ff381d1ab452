/// Pull: what does every patch of surfels send on?
#pragma once
#include <span>

#include "data/surfels.h"

namespace interreflect {

/// The sum of the surfels' flux under every node [Jendersie et al. 2016, 4.1], or where `as_radiosity` the mean of their
/// radiosity by area. radiance: that each surfel reflects or emits, the same in all directions, W/(m^2 sr); more values may
/// follow. std::invalid_argument where there are fewer than surfels.
NodeLight pull(const SurfelTree& tree, std::span<const vec3> radiance, bool as_radiosity);

/// The same light in a third of the memory: each colour is rounded by at most a 512th of its node's largest [Jendersie et al.
/// 2016, 4.7]. The unit is a power of two that takes the brightest node into the range, 2^32 above the least that is not 0.
NodeLight packed(NodeLight light);

}  // namespace interreflect
