// Compiled once for every vector width; the widest that the machine has is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/prefilter/isotropic.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "voxels/prefilter/levels-inl.h"

// Roofline. Per finest texel 8 bytes are cleared and read back from the core's cache, and 1/7 of that for all coarser levels; one
// fused multiply-add of four lanes for each (four for the tent). Memory bounds it: 9.1 bytes a texel written.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace {

/// Volume coverage: the mean. Surface coverage: twice the mean (a quarter of the sum of eight), brought back to opacity 1 where
/// it is more. Premultiplied radiance follows opacity, so its colour is the mean weighted by opacity.
HWY_INLINE V gain(V mean, Coverage coverage) {
    const D d;
    const V one = hn::Set(d, 1.0f);
    if (coverage == Coverage::volume) return one;
    return hn::Min(hn::Set(d, 2.0f), hn::Div(one, hn::Max(alpha_of(mean), hn::Set(d, 1e-6f))));
}

HWY_INLINE V to_columns(V mean, const LevelView& fine, int x, int y, int z) {
    const D d;
    const float found = hn::ExtractLane(mean, 3);
    return found > 0.0f ? hn::Set(d, column_opacity(fine, x, y, z) / found) : hn::Zero(d);
}

/// The rows of finer texels that a row of coarser ones is made of, and their weights.
struct Rows {
    const std::uint16_t* row[16];  // of the first volume
    float weight[16];
    int count = 0;
};
constexpr float tent_weights[4] = {0.125f, 0.375f, 0.375f, 0.125f}, box_weights[2] = {0.5f, 0.5f};

HWY_INLINE Rows rows_below(const LevelView& fine, int y, int z, const IsotropicFilter& filter) {
    const int reach = filter.tent ? 1 : 0, taps = 2 + 2 * reach;
    const float* weights = filter.tent ? tent_weights : box_weights;
    Rows rows;
    for (int k = 0; k < taps; ++k)
        for (int j = 0; j < taps; ++j) {
            const int cy = 2 * y - reach + j, cz = 2 * z - reach + k;
            if (is_air(cy, fine.ny) || is_air(cz, fine.nz)) continue;
            rows.row[rows.count] = fine.texels + at(fine, -1, cy, cz);
            rows.weight[rows.count++] = weights[j] * weights[k];
        }
    return rows;
}

/// The weighted sum of rows, `count` halves long, as floats. Returns whether any of it is not air.
template <class DX>
HWY_INLINE bool add_rows(DX d, const Rows& rows, std::size_t volume, std::size_t begin, std::size_t count, float* sums) {
    const hn::Rebind<hwy::float16_t, DX> half;
    auto any = hn::Zero(d);
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = begin; i + lanes <= count; i += lanes) {
        auto sum = hn::Zero(d);
        for (int k = 0; k < rows.count; ++k)
            sum = hn::MulAdd(hn::PromoteTo(d, hn::LoadU(half, reinterpret_cast<const hwy::float16_t*>(rows.row[k] + volume + i))),
                             hn::Set(d, rows.weight[k]), sum);
        hn::StoreU(sum, d, sums + i);
        any = hn::Or(any, sum);
    }
    return !hn::AllTrue(d, hn::Eq(any, hn::Zero(d)));
}

/// What a row of coarser texels is made of: the rows below it summed, a line of floats for each volume. False where all is air.
HWY_INLINE bool sum_rows(const LevelView& fine, const Rows& rows, int volumes, std::size_t line, float* sums) {
    const D d;
    const hn::ScalableTag<float> wide;
    const std::size_t halves = 4 * (static_cast<std::size_t>(fine.nx) + 2), whole = halves / hn::Lanes(wide) * hn::Lanes(wide);
    for (int v = 0; v < volumes; ++v, sums += line) {
        const std::size_t volume = static_cast<std::size_t>(v) * fine.volume;
        const bool some = add_rows(wide, rows, volume, 0, halves, sums), rest = add_rows(d, rows, volume, whole, halves, sums);
        if (v == 0 && !some && !rest) return false;
        hn::StoreU(hn::Zero(d), d, sums + halves);
        if ((fine.nx & 1) != 0) hn::StoreU(hn::Zero(d), d, sums + halves - 4);
    }
    return true;
}

/// `sums`: for each volume, room for the finer level's row, its border and one texel more.
void reduce_slice(const LevelView& fine, const LevelView& coarse, int z, const IsotropicFilter& filter, float* sums) {
    const D d;
    const int reach = filter.tent ? 1 : 0, taps = 2 + 2 * reach;
    const float* weights = filter.tent ? tent_weights : box_weights;
    const std::size_t line = 4 * (static_cast<std::size_t>(fine.nx) + 3);
    for (int y = 0; y < coarse.ny; ++y) {
        std::uint16_t* row = coarse.texels + at(coarse, 0, y, z);
        if (!sum_rows(fine, rows_below(fine, y, z, filter), filter.volumes, line, sums)) {
            for (std::size_t v = 0; v < static_cast<std::size_t>(filter.volumes); ++v)
                __builtin_memset(row + v * coarse.volume, 0, static_cast<std::size_t>(coarse.nx) * 4 * sizeof(*row));
            continue;
        }
        for (int x = 0; x < coarse.nx; ++x) {
            V scale = hn::Zero(d);
            for (std::size_t v = 0; v < static_cast<std::size_t>(filter.volumes); ++v) {
                const float* first = sums + v * line + 4 * (2 * x + 1 - reach);
                V mean = hn::Zero(d);
                for (int i = 0; i < taps; ++i) mean = hn::MulAdd(hn::LoadU(d, first + 4 * i), hn::Set(d, weights[i]), mean);
                if (v == 0) scale = filter.columns ? to_columns(mean, fine, x, y, z) : gain(mean, filter.coverage);
                const V value = hn::Mul(mean, scale);
                store(filter.eight_bits ? eight_bits(value) : value, row + 4 * x + v * coarse.volume);
            }
        }
    }
}

/// Four volumes of one voxel, each by `write(volume, texel)`. Of a step between two hemispheres band 0 is the mean, and band 1,
/// whose three functions are the direction's coordinates c with mean c^2 = 1/3, is 3 times the mean of (B - F)/2 |d . n|:
/// 3/4 (B - F) n.
template <class Write>
HWY_INLINE void write_harmonics(const VoxelView& voxels, std::size_t i, const Write& write) {
    const D d;
    const V front = premultiplied(voxels.radiance + 3 * i, voxels.opacity[i], voxels.inverse_scale);
    if (voxels.back == nullptr) {
        write(0, front);
        for (std::size_t v = 1; v < 4; ++v) write(v, hn::Zero(d));
        return;
    }
    const V back = premultiplied(voxels.back + 3 * i, voxels.opacity[i], voxels.inverse_scale), half = hn::Set(d, 0.5f);
    write(0, hn::Mul(hn::Add(front, back), half));
    const V step = hn::Mul(hn::Sub(back, front), hn::Set(d, 0.75f));  // opacity cancels
    for (std::size_t axis = 0; axis < 3; ++axis)
        write(axis + 1, hn::Mul(step, hn::Set(d, voxels.normal[i * voxels.normal_stride + axis])));
}

/// The four volumes of one voxel after the other; `texels`: of voxel 0.
void write_packed_harmonics(std::uint16_t* texels, const VoxelView& voxels) {
    for (std::size_t i = voxels.begin; i < voxels.end; ++i)
        write_harmonics(voxels, i, [&](std::size_t v, V texel) HWY_ATTR { store(texel, texels + 4 * (4 * i + v)); });
}

/// The four volumes of slices 2 z and 2 z + 1.
void write_slices_harmonics(const LevelView& level, const VoxelView& voxels, int z) {
    VoxelView none = voxels;
    none.end = none.begin;
    LevelView volumes[4] = {level, level, level, level};
    for (std::size_t v = 0; v < 4; ++v) {
        volumes[v].texels += v * level.volume;
        write_slices(volumes[v], none, z, false);
    }
    over_voxels(level, voxels, [&](std::size_t i, const Texel& texel, bool inner) HWY_ATTR {
        write_harmonics(voxels, i, [&](std::size_t v, V value) HWY_ATTR { write_voxel(volumes[v], texel, inner, value); });
    });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "voxels/prefilter/bricks.h"

namespace interreflect {
namespace {
HWY_EXPORT(reduce_slice);
HWY_EXPORT(write_slices);
HWY_EXPORT(write_slices_harmonics);
HWY_EXPORT(write_packed);
HWY_EXPORT(write_packed_harmonics);

template <class Write>
void build_filtered(Pyramid& pyramid, const VoxelView& voxels, const IsotropicFilter& filter, const Write& write,
                    const PackVoxels& pack) {
    const auto reduce = [&](const LevelView& fine, const LevelView& coarse, int z) {
        thread_local std::vector<float> sums;
        sums.resize(4 * (static_cast<std::size_t>(fine.nx) + 3) * static_cast<std::size_t>(filter.volumes));
        HWY_DYNAMIC_DISPATCH(reduce_slice)(fine, coarse, z, filter, sums.data());
    };
    if (pyramid.levels[0].dense())
        build_levels(pyramid, voxels, filter.tent || filter.columns, write, reduce);
    else
        build_levels_in_bricks(pyramid, voxels, {pack, of_slices(reduce)}, reduce);
}

}  // namespace

Pyramid build_isotropic(Coverage coverage, bool columns, const IsotropicKnobs& knobs, const LitVoxels& lit) {
    const IsotropicFilter filter{coverage, knobs.kernel == "tent", knobs.format == "rgba8", columns};
    Pyramid pyramid = make_levels(*lit.grid, 1, knobs);
    const float scale = radiance_scale(lit);  // refuses what is not finite
    pyramid.scale = filter.eight_bits ? 1.0f : scale;
    build_filtered(
        pyramid, view(lit, pyramid.scale), filter,
        [&](const LevelView& level, const VoxelView& voxels, int z) {
            HWY_DYNAMIC_DISPATCH(write_slices)(level, voxels, z, filter.eight_bits);
        },
        [&](std::uint16_t* texels, const VoxelView& voxels) {
            HWY_DYNAMIC_DISPATCH(write_packed)(texels, voxels, filter.eight_bits);
        });
    return pyramid;
}

Pyramid build_harmonics(bool columns, const LevelKnobs& knobs, const LitVoxels& lit) {
    Pyramid pyramid = make_levels(*lit.grid, 4, knobs);
    pyramid.scale = radiance_scale(lit);
    const Normals normals = in_body(front_normals(lit), lit);
    build_filtered(
        pyramid, view(lit, pyramid.scale, normals), {Coverage::surface, false, false, columns, 4},
        [](const LevelView& level, const VoxelView& voxels, int z) {
            HWY_DYNAMIC_DISPATCH(write_slices_harmonics)(level, voxels, z);
        },
        [](std::uint16_t* texels, const VoxelView& voxels) {
            HWY_DYNAMIC_DISPATCH(write_packed_harmonics)
            (texels, voxels);
        });
    return pyramid;
}

}  // namespace interreflect
#endif
