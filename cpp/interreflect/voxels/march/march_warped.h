/// Cones through warped voxels or nested grids: as march_cones.h, but level and step follow the voxels where the cone is.
#pragma once
#include "voxels/march/march_cones.h"
#include "voxels/march/receivers.h"

namespace interreflect {

/// As march_cones, of a pyramid whose domain is not plain.
ConeCounts march_warped(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch);

/// set_warped_start for all receivers.
void start_warped(const Domain& domain, float normal_offset, bool see_own_surface, const Receivers& receivers, ConeBatch& batch);

}  // namespace interreflect
