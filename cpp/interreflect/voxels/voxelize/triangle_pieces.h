/// The scene's triangles as voxelizations are handed them.
#pragma once
#include <functional>
#include <vector>

#include "voxels/voxelize/contribution.h"
#include "voxels/voxelize/triangle_packet.h"

namespace interreflect {

/// Triangles [begin, end) of one instance.
struct TriangleRange {
    std::uint32_t instance, begin, end;
};
/// All triangles in ranges of a fixed size.
std::vector<TriangleRange> triangle_ranges(const Geometry& geometry);

/// Calls visit(VoxelTriangle) for every triangle of a range that may lie in the domain, but for those without area: as it is in a
/// plain domain, else as `handing` says.
///
/// Pieces are so small that the warp moves no point of them by more than 1/32 voxel (Handing::sampled: 1/2) from where a flat
/// piece would have it; they are cut at the faces of a view volume and of nested grids.
using VisitTriangle = std::function<void(const VoxelTriangle&)>;
/// Which of a packet's triangles need not be visited: of no use to a voxelization, or dealt with there and then. Asked before
/// anything else is known of them, and not in nested grids.
using PassOver = std::function<std::uint32_t(const TrianglePacket&, std::uint32_t lanes)>;
void for_each_triangle(const Scene& scene, const Domain& domain, Handing handing, const TriangleRange& range,
                       const VisitTriangle& visit, const PassOver& pass_over = {});

}  // namespace interreflect
