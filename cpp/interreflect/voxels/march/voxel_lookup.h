/// What a ray's hit looks like in the voxels.
#pragma once
#include "data/scene.h"
#include "data/voxel_grid.h"
#include "visibility/intersector.h"
#include "visibility/surface.h"

namespace interreflect {

/// Radiance of the finest voxel at a hit point, W/(m^2 sr), on the side that the ray came from: of the voxel that holds the
/// point, or, where rounding or the voxelization left that empty, of the nearest one beside it. 0 where there is none, and on the
/// back of a one-sided surface. Of several hierarchies, in that of the body that was hit, else in that of the world.
vec3 radiance_at_hit(Pyramids pyramids, const Scene& scene, const Hit& hit, const vec3& direction);

}  // namespace interreflect
