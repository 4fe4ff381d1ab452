/// Voxels of a body where it has moved to.
#pragma once
#include "data/voxel_grid.h"

namespace interreflect {

/// The same cells, with positions, normals and points where the body's surface is at `pose`: nothing is voxelized anew.
VoxelGrid move_voxels(const VoxelGrid& voxels, const BodyPose& pose);

}  // namespace interreflect
