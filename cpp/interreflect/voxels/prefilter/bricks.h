/// Levels in bricks, made layer by layer by the kernels that make dense ones.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>

#include "data/voxel_grid.h"
#include "voxels/prefilter/levels.h"

namespace interreflect {

/// Makes slice z of `coarse` from slices 2 z and 2 z + 1 of `fine`, where those two and one more on either side are laid out.
/// `packed`: every volume of the finer level, of which `fine` may have the first only.
using ReduceLayer = std::function<void(const LevelView& fine, const PackedView& packed, const LevelView& coarse, int z)>;

/// Writes voxels [begin, end) one after the other, all volumes of each; `texels`: of voxel 0.
using PackVoxels = std::function<void(std::uint16_t* texels, const VoxelView& voxels)>;

struct BrickFilter {
    PackVoxels pack;
    ReduceLayer reduce;
    int laid_out = 8;         // how many volumes `reduce` reads in `fine` at most
    ReduceLayer second = {};  // for the second level, where that is made in another way
};

/// A filter of single slices.
template <class Reduce>
ReduceLayer of_slices(const Reduce& reduce) {
    return [reduce](const LevelView& fine, const PackedView&, const LevelView& coarse, int z) { reduce(fine, coarse, z); };
}

/// The levels in bricks, and the dense one after them (without its border); returns its number, or that of levels where there is
/// none.
std::size_t build_bricks(Pyramid& pyramid, const VoxelView& voxels, const BrickFilter& filter);

/// Every level of a pyramid whose finest is in bricks; `reduce`: of dense levels.
template <class Reduce>
void build_levels_in_bricks(Pyramid& pyramid, const VoxelView& voxels, const BrickFilter& filter, const Reduce& reduce) {
    reduce_coarse(pyramid, reduce, build_bricks(pyramid, voxels, filter));
    pyramid.counts.voxels = voxels.end;
}

}  // namespace interreflect
