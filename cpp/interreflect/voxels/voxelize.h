/// Voxelize: which cells of a grid does the scene's surface pass through, and what does it look like there?
///
///   VoxelGrid voxelize(const Technique&, const Scene&, const Domain&);
///
/// Every technique marks a cell at most once, and averages albedo, emission and normal over what fell into it. Textures are
/// filtered at a voxel's footprint. Masked texels are air. The averaged normal is that of the front sides (by winding).
/// Exact counterpart: ExactOverlap.
#pragma once
#include <variant>

#include "voxels/voxelize/exact_overlap.h"
#include "voxels/voxelize/rasterization.h"
#include "voxels/voxelize/surface_sampling.h"
#include "voxels/voxelize/tessellation.h"

namespace interreflect {
using Voxelize = std::variant<ExactOverlap, SurfaceSampling, Rasterization, Tessellation>;
}
