/// What every prefilter shares: a pyramid's levels, its finest level written from the voxels, its borders.
#pragma once
#include "data/voxel_grid.h"

namespace interreflect {

/// How eight texels become one.
enum class Coverage { volume, surface };

/// The pyramid's empty levels: memory not yet written.
Pyramid make_levels(const Domain& domain, int faces);

/// The power of two that brings the largest radiance just below 2^15; 1 where there is none. Throws std::invalid_argument where a
/// radiance is not finite.
float radiance_scale(const LitVoxels& lit);

/// Every level of one face: the finest one cleared and written from the voxels, each other one reduced from the one below it.
Pyramid build_isotropic(Coverage coverage, const LitVoxels& lit);

/// Six faces from the second level on.
Pyramid build_anisotropic(const LitVoxels& lit);

}  // namespace interreflect
