/// What every voxelization shares: triangles brought into voxels, and the parts of triangles in cells merged into voxels.
///
/// A technique emits contributions, triangle by triangle, in fixed pieces; they are merged cell by cell in the order of the
/// pieces, so the result is the same at any number of threads.
#pragma once
#include <functional>

#include "voxels/voxelize/contribution_sink.h"

namespace interreflect {

/// Calls `emit` for every triangle of the scene and merges what it adds to the sink.
using EmitTriangle = std::function<void(const VoxelTriangle&, ContributionSink&)>;
VoxelGrid voxelize_triangles(const Scene& scene, const Domain& domain, Handing handing, const EmitTriangle& emit);

}  // namespace interreflect
