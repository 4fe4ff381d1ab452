/// On which sides of the surface surfels lie.
#pragma once
#include "data/scene.h"
#include "data/surfels.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Of surfels on fronts those whose front sees the front of something, and a second one on the back of each that lies on a
/// two-sided material where that side does. Nobody sees the others: outside of a room, inside of a solid, under what stands on a
/// floor; they would only darken the patches that they belong to.
Surfels open_sides(const Surfels& fronts, const Scene& scene, const Intersector& intersector);

}  // namespace interreflect
