/// Levels in bricks, made block by block by the kernels that make dense ones.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>

#include "data/voxel_grid.h"
#include "voxels/prefilter/levels.h"

namespace interreflect {

/// 4 x 4 x 4 texels of a level that are made, and the 8 x 8 x 8 below them with a border of one, which holds their neighbours: to
/// a filter they are two small dense levels. Fewer where the level ends.
struct TexelBlock {
    static constexpr int side = 8, edge = side + 2, volume = edge * edge * edge;

    LevelView fine, coarse;
    const std::uint32_t* number;  // of the finer texels, border included, x fastest

    std::uint32_t number_at(int x, int y, int z) const { return number[(x + 1) + edge * ((y + 1) + edge * (z + 1))]; }
};
using ReduceBlock = std::function<void(const TexelBlock&)>;

/// Writes voxels [begin, end) one after the other; `texels`: of voxel 0 in the first volume, whose size is in halves.
using PackVoxels = std::function<void(std::uint16_t* texels, std::size_t volume, const VoxelView& voxels)>;

/// A filter of single slices, applied to all of a block's.
template <class Reduce>
ReduceBlock of_slices(const Reduce& reduce) {
    return [reduce](const TexelBlock& block) {
        for (int z = 0; z < block.coarse.nz; ++z) reduce(block.fine, block.coarse, z);
    };
}

/// The levels in bricks, and the dense one after them (without its border); returns its number, or that of levels where there is
/// none. `second`: for the second level, where that is made in another way.
std::size_t build_bricks(Pyramid& pyramid, const VoxelView& voxels, const PackVoxels& pack, const ReduceBlock& reduce,
                         const ReduceBlock& second = {});

/// Every level of a pyramid whose finest is in bricks.
template <class Reduce>
void build_levels_in_bricks(Pyramid& pyramid, const VoxelView& voxels, const PackVoxels& pack, const Reduce& reduce,
                            const ReduceBlock& second = {}) {
    reduce_coarse(pyramid, reduce, build_bricks(pyramid, voxels, pack, of_slices(reduce), second));
    pyramid.counts.voxels = voxels.end;
}

}  // namespace interreflect
