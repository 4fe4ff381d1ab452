/// Cones through warped voxels or nested grids: as march_cones.h, but level and step follow the voxels where the cone is.
#pragma once
#include "voxels/march/march_cones.h"

namespace interreflect {

/// As march_cones, of a pyramid whose domain is not plain.
ConeCounts march_warped(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch);

}  // namespace interreflect
