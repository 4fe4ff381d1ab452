/// Place surfels: which disks stand for the scene's still surface?
///
///   Surfels place_surfels(const Technique&, const Scene&, const Intersector&);
///
/// All have the same area, and together that of the still surface's triangles, less what masks leave out. The front is where the
/// winding says. Bodies have none: they receive light and send none on. No exact counterpart: AllSurfels (link) uses any.
#pragma once
#include <variant>

#include "surfels/place/halton_surfels.h"
#include "surfels/place/relaxed_surfels.h"
#include "surfels/place/xorshift_surfels.h"

namespace interreflect {
using PlaceSurfels = std::variant<HaltonSurfels, XorshiftSurfels, RelaxedSurfels>;
}
