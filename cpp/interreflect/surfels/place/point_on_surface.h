/// Surfels at given points of the still surface's triangles.
#pragma once
#include <functional>

#include "data/scene.h"
#include "data/surfels.h"

namespace interreflect {

/// A point of the unit square for surfel `number` of all; called in order.
using PointOfSquare = std::function<vec2(std::uint32_t number)>;

/// `count` surfels of equal areas that sum up to the still surface's, as many on every triangle as its area asks for: what is
/// left over counts for the next, so small triangles gather up to one surfel [Jendersie et al. 2016, 4.2]. Those that a mask
/// leaves out are dropped, with their area.
Surfels surfels_by_area(const Scene& scene, int count, const PointOfSquare& point);

}  // namespace interreflect
