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
    int nx, ny, nz, faces;
    std::size_t row, slice, volume;
};
/// The texels of a level in bricks, and the number of the one at (x, y, z), which begins 4 times that further: 0 is air.
/// `number`: of texel (0, 0, 0).
struct PackedView {
    const std::uint16_t* texels = nullptr;
    const std::uint32_t* number = nullptr;
    std::size_t row = 0, slice = 0;
};
/// Normals as filters compare them with directions, `stride` floats from one to the next.
struct Normals {
    const float* first = nullptr;
    std::size_t stride = 3;
    Buffer<vec3> own{};  // where they are not the voxels' as they are
};
/// The voxels of some slices of one grid; its first cell has the number `base`.
struct VoxelView {
    const std::uint32_t* cell;
    const float *radiance, *back, *opacity, *normal;
    std::size_t normal_stride, begin, end;
    float inverse_scale;
    std::uint32_t base = 0;
};

/// The most bytes of a pyramid.
constexpr std::uint64_t most_bytes = std::uint64_t{4} << 30;

/// The pyramid's empty levels, at most as many as the knobs say: memory not yet written. Those in bricks, which come first, have
/// only the bricks' count. Throws std::invalid_argument where they
/// would take more than `most_bytes` besides those in bricks, or where fewer levels are allowed than there are nested grids.
Pyramid make_levels(const VoxelGrid& grid, int faces, const LevelKnobs& knobs);

/// The power of two that brings the largest radiance just below 2^15; 1 where there is none. Throws std::invalid_argument where a
/// radiance is not finite.
float radiance_scale(const LitVoxels& lit);

LevelView view(Pyramid::Level& level);
/// The texels of level i + 1 that level i fills: all, but of a level that is a nested grid itself.
LevelView above(Pyramid& pyramid, std::size_t i);

/// Means of the front sides' normals, and normals of the points where fronts are lit: world space.
Normals mean_normals(const LitVoxels& lit);
Normals front_normals(const LitVoxels& lit);
/// The same in the space of the body whose voxels they are.
Normals in_body(Normals normals, const LitVoxels& lit);
/// The same in the axes of a body's or a warped grid, along which its texels are looked at: what is perpendicular to surfaces
/// there.
Normals in_grid(Normals normals, const LitVoxels& lit);
/// All voxels, with radiance divided by `scale`.
VoxelView view(const LitVoxels& lit, float scale, const Normals& normals = {});
/// The voxels of a grid in slices 2 z and 2 z + 1 of its level.
VoxelView slices_of(VoxelView voxels, const LevelView& level, int z);

/// Repeats the outermost texels of every slice in its border, and the outermost slices; or fills the border with air.
void fill_border(Pyramid::Level& level);

/// The slices of one level, or of a box in it, in pieces worth a thread's while.
template <class Body>
void over_slices(const LevelView& level, const Body& body) {
    const std::size_t per_slice = static_cast<std::size_t>(level.nx) * level.ny * level.faces;
    const std::size_t block = 1 + 4096 / (1 + per_slice);
    parallel_blocks(static_cast<std::size_t>(level.nz), block, [&](std::size_t begin, std::size_t end) {
        for (std::size_t z = begin; z < end; ++z) body(static_cast<int>(z));
    });
}

/// `write(level, voxels, z)` clears slices 2 z and 2 z + 1 of a nested grid's level and puts that grid's voxels in.
template <class Write>
void write_grid(Pyramid& pyramid, VoxelView voxels, int grid, const Write& write) {
    const LevelView level = view(pyramid.levels[static_cast<std::size_t>(grid)]);
    voxels.base = pyramid.domain.cell(ivec3(0), grid);
    parallel_pieces(static_cast<std::size_t>((level.nz + 1) / 2), [&](std::size_t piece) {
        const int z = static_cast<int>(piece);
        write(level, slices_of(voxels, level, z), z);
    });
}
/// All nested grids but the finest: each has no voxels where a finer one lies, whose texels come there later.
template <class Write>
void write_coarse_grids(Pyramid& pyramid, const VoxelView& voxels, const Write& write) {
    for (int grid = 1; grid < pyramid.domain.cascades; ++grid) write_grid(pyramid, voxels, grid, write);
}

/// Levels after number `made`, each from the one below it by `reduce(fine, coarse, slice)`, and the borders from that one on: the
/// second level is made beside the finest, whose slices are then still in the core's cache.
template <class Reduce>
void reduce_coarse(Pyramid& pyramid, const Reduce& reduce, std::size_t made = 1) {
    if (pyramid.levels[0].open) fill_border(pyramid.levels[0]);
    for (std::size_t i = made; i < pyramid.levels.size(); ++i) {
        if (i > made) {
            const LevelView fine = view(pyramid.levels[i - 1]), coarse = above(pyramid, i - 1);
            over_slices(coarse, [&](int z) { reduce(fine, coarse, z); });
        }
        fill_border(pyramid.levels[i]);
    }
}

/// Every level: nested grids by `write`, what is coarser by `reduce`. `reaches`: into slices that other pieces write.
template <class Write, class Reduce>
void build_levels(Pyramid& pyramid, const VoxelView& voxels, bool reaches, const Write& write, const Reduce& reduce) {
    write_coarse_grids(pyramid, voxels, write);
    const bool more = pyramid.levels.size() > 1;
    const LevelView coarse = more ? above(pyramid, 0) : LevelView{};
    write_grid(pyramid, voxels, 0, [&](const LevelView& finest, const VoxelView& inside, int z) {
        write(finest, inside, z);
        if (more && !reaches) reduce(finest, coarse, z);
    });
    if (more && reaches) over_slices(coarse, [&](int z) { reduce(view(pyramid.levels[0]), coarse, z); });
    reduce_coarse(pyramid, reduce);
    pyramid.counts.voxels = voxels.end;
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
