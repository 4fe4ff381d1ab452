/// What every prefilter shares: a pyramid's levels, its finest level written from the voxels, its borders.
#pragma once
#include <algorithm>

#include "data/voxel_grid.h"
#include "math/parallel.h"
#include "voxels/prefilter/filter_knobs.h"

namespace interreflect {

/// How eight texels become one.
enum class Coverage { volume, surface };
/// Of one opacity for all directions; of several volumes the first one's opacity scales all.
struct IsotropicFilter {
    Coverage coverage;
    bool tent, eight_bits, columns;
    int volumes = 1;
};

/// A level as plain numbers, in halves: kernels of several targets share no functions.
struct LevelView {
    std::uint16_t* texels;
    int nx, ny, nz;
    std::size_t row, slice, volume;
};
/// The voxels of some slices of the finest level.
struct VoxelView {
    const std::uint32_t* cell;
    const float *radiance, *back, *normal, *opacity;
    const VoxelPoint* points;
    std::size_t begin, end;
    float inverse_scale;
};

/// The pyramid's empty levels, at most as many as the knobs say: memory not yet written.
Pyramid make_levels(const Domain& domain, int faces, const LevelKnobs& knobs);

/// The power of two that brings the largest radiance just below 2^15; 1 where there is none. Throws std::invalid_argument where a
/// radiance is not finite.
float radiance_scale(const LitVoxels& lit);

LevelView view(Pyramid::Level& level);
/// All voxels, with radiance divided by `scale`.
VoxelView view(const LitVoxels& lit, float scale);
/// The voxels in slices 2 z and 2 z + 1.
VoxelView slices_of(VoxelView voxels, const Domain& domain, int z);

/// Repeats the outermost texels of every slice in its border, and the outermost slices.
void fill_border(Pyramid::Level& level);

/// The slices of one level in pieces worth a thread's while.
template <class Body>
void over_slices(const Pyramid::Level& level, const Body& body) {
    const std::size_t per_slice = static_cast<std::size_t>(level.size.x) * level.size.y * level.faces;
    const std::size_t block = std::max<std::size_t>(1, 4096 / per_slice);
    parallel_blocks(static_cast<std::size_t>(level.size.z), block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) body(static_cast<int>(z));
    });
}

/// Levels from the third on, each from the one below it by `reduce(fine, coarse, slice)`, and the borders of all but the finest:
/// the second level is made beside the finest, whose slices are then still in the core's cache.
template <class Reduce>
void reduce_coarse(Pyramid& pyramid, const Reduce& reduce) {
    for (std::size_t i = 1; i < pyramid.levels.size(); ++i) {
        if (i > 1) {
            const LevelView fine = view(pyramid.levels[i - 1]), coarse = view(pyramid.levels[i]);
            over_slices(pyramid.levels[i], [&](int z) { reduce(fine, coarse, z); });
        }
        fill_border(pyramid.levels[i]);
    }
}

/// `columns`: of OpacityKnob. Every level of one face: the finest one cleared and written from the voxels, each other one reduced
/// from the one below it.
Pyramid build_isotropic(Coverage coverage, bool columns, const IsotropicKnobs& knobs, const LitVoxels& lit);

/// Four volumes: the mean radiance and opacity, and what the radiance gains per unit of the direction along x, y and z.
Pyramid build_harmonics(bool columns, const LevelKnobs& knobs, const LitVoxels& lit);

/// Six faces from the second level on.
Pyramid build_anisotropic(const LevelKnobs& knobs, const LitVoxels& lit);

/// Eight octants of directions at every level.
Pyramid build_octants(bool columns, const LevelKnobs& knobs, const LitVoxels& lit);

}  // namespace interreflect
