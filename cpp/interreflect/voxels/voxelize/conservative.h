#pragma once
#include <span>

#include "voxels/voxelize/contributions.h"
#include "voxels/voxelize/linear_box.h"

namespace interreflect {

/// Rasterizes a triangle conservatively: into every pixel that it touches, and there into every cell that its plane crosses
/// within the triangle's range of depths, inside the triangle or not, as a fragment extrapolated over the whole pixel does.
///
/// The triangle's area in a pixel is exact; its cells share it as they share the plane. `samples` look up masks.
void rasterize_conservatively(const VoxelTriangle& triangle, const LinearBox& box, int oversampling,
                              std::span<const vec2> samples, ContributionSink& sink);

}  // namespace interreflect
