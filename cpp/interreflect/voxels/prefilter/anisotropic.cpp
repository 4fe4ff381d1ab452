// Compiled once for every vector width; the widest that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/prefilter/anisotropic.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "voxels/prefilter/levels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace {
void reduce_slice_faces(const LevelView& fine, const LevelView& coarse, int z) {
    const D d;
    for (int face = 0; face < 6; ++face) {
        LevelView seen = fine;
        seen.texels += static_cast<std::size_t>(face) * fine.volume;
        for (int y = 0; y < coarse.ny; ++y) {
            std::uint16_t* out = coarse.texels + static_cast<std::size_t>(face) * coarse.volume + at(coarse, 0, y, z);
            for (int x = 0; x < coarse.nx; ++x, out += 4) {
                V value = hn::Zero(d);
                if (!all_air(seen, x, y, z)) {
                    const Children c = children(seen, x, y, z);
                    V texel[8];
                    for (int i = 0; i < 8; ++i) texel[i] = load(c.texel[i]);
                    value = composite(texel, face);
                }
                store(value, out);
            }
        }
    }
}

/// What one voxel shows through a face: its front, or its back where the front clearly faces away. Seen edge on (up to 17 degrees
/// beyond the silhouette), a surface still shows its front: at the grazing angles of a wall that is lit on one side, an eye on
/// that side sees nothing else.
HWY_INLINE V sided(const VoxelView& voxels, std::size_t i, int face) {
    const D d;
    const float outwards =
        voxels.normal[i * voxels.normal_stride + static_cast<std::size_t>(face >> 1)] * ((face & 1) != 0 ? 1.0f : -1.0f);
    const float back = outwards >= -0.3f ? 0.0f : outwards <= -0.5f ? 1.0f : (-0.3f - outwards) * 5.0f;
    const V front_side = premultiplied(voxels.radiance + 3 * i, voxels.opacity[i], voxels.inverse_scale);
    if (back == 0.0f || voxels.back == nullptr) return front_side;
    const V back_side = premultiplied(voxels.back + 3 * i, voxels.opacity[i], voxels.inverse_scale);
    return hn::MulAdd(hn::Sub(back_side, front_side), hn::Set(d, back), front_side);
}

/// The six faces of slices 2 z and 2 z + 1 of a grid's level.
void write_slices_faces(const LevelView& level, const VoxelView& voxels, int z) {
    VoxelView none = voxels;
    none.end = none.begin;
    for (int face = 0; face < 6; ++face) {
        LevelView volume = level;
        volume.texels += static_cast<std::size_t>(face) * level.volume;
        write_slices(volume, none, z, false);
        over_voxels(level, voxels, [&](std::size_t i, const Texel& texel, bool inner) HWY_ATTR {
            write_voxel(volume, texel, inner, sided(voxels, i, face));
        });
    }
}

/// One slice of the second level's six faces, from the voxels themselves; number 1 + voxel of the texels of the two slices of the
/// finest level below it, 0 where there is none.
void first_faces_slice(const LevelView& finest, const PackedView& packed, const LevelView& coarse, const VoxelView& voxels,
                       int z) {
    const D d;
    for (int y = 0; y < coarse.ny; ++y)
        for (int x = 0; x < coarse.nx; ++x) {
            std::uint32_t child[8], any = 0;
            for (int i = 0; i < 8; ++i) {
                const int cx = 2 * x + (i & 1), cy = 2 * y + ((i >> 1) & 1), cz = 2 * z + (i >> 2);
                const bool inside = cx < finest.nx && cy < finest.ny && cz < finest.nz;
                child[i] = inside ? number_at(packed, cx, cy, cz) : 0;
                any |= child[i];
            }
            for (int face = 0; face < 6; ++face) {
                V value = hn::Zero(d);
                if (any != 0) {
                    V texel[8];
                    for (int i = 0; i < 8; ++i) texel[i] = child[i] != 0 ? sided(voxels, child[i] - 1, face) : hn::Zero(d);
                    value = composite(texel, face);
                }
                store(value, coarse.texels + static_cast<std::size_t>(face) * coarse.volume + at(coarse, x, y, z));
            }
        }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

#include "math/parallel.h"
#include "voxels/prefilter/bricks.h"

namespace interreflect {
namespace {
HWY_EXPORT(reduce_slice_faces);
HWY_EXPORT(write_slices);
HWY_EXPORT(write_slices_faces);
HWY_EXPORT(first_faces_slice);
HWY_EXPORT(write_packed);
}  // namespace

Pyramid build_anisotropic(const LevelKnobs& knobs, const LitVoxels& lit) {
    Pyramid pyramid = make_levels(*lit.grid, 6, knobs);
    pyramid.scale = radiance_scale(lit);
    const Normals normals = in_grid(mean_normals(lit), lit);
    const VoxelView voxels = view(lit, pyramid.scale, normals);
    const auto reduce = [](const LevelView& fine, const LevelView& filled, int z) {
        HWY_DYNAMIC_DISPATCH(reduce_slice_faces)(fine, filled, z);
    };
    if (!pyramid.levels[0].dense()) {
        const auto pack = [](std::uint16_t* texels, const VoxelView& some) {
            HWY_DYNAMIC_DISPATCH(write_packed)(texels, some, false);
        };
        const auto second = [&](const LevelView& finest, const PackedView& packed, const LevelView& coarse, int z) {
            HWY_DYNAMIC_DISPATCH(first_faces_slice)(finest, packed, coarse, voxels, z);
        };
        build_levels_in_bricks(pyramid, voxels, {pack, of_slices(reduce), 6, second}, reduce);
        return pyramid;
    }
    write_coarse_grids(pyramid, voxels, [](const LevelView& level, const VoxelView& inside, int z) {
        HWY_DYNAMIC_DISPATCH(write_slices_faces)(level, inside, z);
    });
    const bool more = pyramid.levels.size() > 1;
    const LevelView coarse = more ? above(pyramid, 0) : LevelView{};
    write_grid(pyramid, voxels, 0, [&](const LevelView& finest, const VoxelView& inside, int z) {
        HWY_DYNAMIC_DISPATCH(write_slices)(finest, inside, z, false);
        if (!more) return;
        std::vector<std::uint32_t> number(2 * static_cast<std::size_t>(finest.nx) * static_cast<std::size_t>(finest.ny), 0);
        const auto base = static_cast<std::uint32_t>(static_cast<std::size_t>(z) * number.size());
        for (std::size_t i = inside.begin; i < inside.end; ++i) number[inside.cell[i] - base] = static_cast<std::uint32_t>(i + 1);
        const std::size_t row = static_cast<std::size_t>(finest.nx), slice = row * static_cast<std::size_t>(finest.ny);
        const PackedView packed{nullptr, number.data() - 2 * static_cast<std::size_t>(z) * slice, row, slice};
        HWY_DYNAMIC_DISPATCH(first_faces_slice)(finest, packed, coarse, inside, z);
    });
    reduce_coarse(pyramid, reduce);
    pyramid.counts.voxels = lit.grid->size();
    return pyramid;
}

}  // namespace interreflect
#endif
