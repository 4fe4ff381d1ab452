/// What every voxelization shares: triangles brought into voxels, and the parts of triangles in cells merged into voxels.
///
/// A technique emits contributions, triangle by triangle, in fixed pieces; they are merged cell by cell in the order of the
/// pieces, so the result is the same at any number of threads.
#pragma once
#include <functional>

#include "voxels/voxelize/contribution_sink.h"
#include "voxels/voxelize/triangle_pieces.h"

namespace interreflect {

/// How a voxel's albedo and normal come of its contributions: averaged by area, or those of the contribution whose albedo has the
/// greatest contrast [Doghramachi 2013], the first of equals.
enum class Blend { mean, max };

/// Calls `emit` for every triangle of the scene and merges what it adds to the sink.
using EmitTriangle = std::function<void(const VoxelTriangle&, ContributionSink&)>;
/// As PassOver, with the sink.
using EmitPacket = std::function<std::uint32_t(const TrianglePacket&, std::uint32_t lanes, ContributionSink&)>;
VoxelGrid voxelize_triangles(const Scene& scene, const Domain& domain, Handing handing, const EmitTriangle& emit,
                             Blend blend = Blend::mean, const EmitPacket& emit_packet = {});

}  // namespace interreflect
