/// The bricks of a level from the places of its texels.
#pragma once
#include <cstdint>
#include <span>

#include "data/voxel_grid.h"

namespace interreflect {

/// Fills in the bricks (whose count is known) of a level whose texel number i + 1 stands in `cells[i]`, x fastest, ascending. The
/// outermost texels stand in the border too.
void index_bricks(Pyramid::Level& level, std::span<const std::uint32_t> cells);

}  // namespace interreflect
