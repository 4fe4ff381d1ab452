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
HWY_INLINE V reduce(V mean, const IsotropicFilter& filter) {
    const D d;
    if (filter.coverage == Coverage::surface)
        mean = hn::Mul(mean, hn::Min(hn::Set(d, 2.0f), hn::Div(hn::Set(d, 1.0f), hn::Max(alpha_of(mean), hn::Set(d, 1e-6f)))));
    return filter.eight_bits ? eight_bits(mean) : mean;
}

/// The rows of finer texels that a row of coarser ones is made of, and their weights.
struct Rows {
    const std::uint16_t* row[16];
    float weight[16];
    int count = 0;
};
constexpr float tent_weights[4] = {0.125f, 0.375f, 0.375f, 0.125f}, box_weights[2] = {0.5f, 0.5f};

/// A texel beyond an odd size is air; beyond an even one the border repeats the outermost, which keeps all of its weight then.
HWY_INLINE bool is_air(int at, int size) { return at >= size && (at > size || (size & 1) != 0); }

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
HWY_INLINE bool add_rows(DX d, const Rows& rows, std::size_t begin, std::size_t count, float* sums) {
    const hn::Rebind<hwy::float16_t, DX> half;
    auto any = hn::Zero(d);
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = begin; i + lanes <= count; i += lanes) {
        auto sum = hn::Zero(d);
        for (int k = 0; k < rows.count; ++k)
            sum = hn::MulAdd(hn::PromoteTo(d, hn::LoadU(half, reinterpret_cast<const hwy::float16_t*>(rows.row[k] + i))),
                             hn::Set(d, rows.weight[k]), sum);
        hn::StoreU(sum, d, sums + i);
        any = hn::Or(any, sum);
    }
    return !hn::AllTrue(d, hn::Eq(any, hn::Zero(d)));
}

/// `sums`: room for the finer level's row, its border and one texel more.
void reduce_slice(const LevelView& fine, const LevelView& coarse, int z, const IsotropicFilter& filter, float* sums) {
    const D d;
    const hn::ScalableTag<float> wide;
    const std::size_t halves = 4 * (static_cast<std::size_t>(fine.nx) + 2), whole = halves / hn::Lanes(wide) * hn::Lanes(wide);
    const int reach = filter.tent ? 1 : 0, taps = 2 + 2 * reach;
    const float* weights = filter.tent ? tent_weights : box_weights;
    for (int y = 0; y < coarse.ny; ++y) {
        std::uint16_t* out = coarse.texels + at(coarse, 0, y, z);
        const Rows rows = rows_below(fine, y, z, filter);
        const bool some = add_rows(wide, rows, 0, halves, sums), rest = add_rows(d, rows, whole, halves, sums);
        if (!some && !rest) {
            __builtin_memset(out, 0, static_cast<std::size_t>(coarse.nx) * 4 * sizeof(*out));
            continue;
        }
        hn::StoreU(hn::Zero(d), d, sums + halves);
        if ((fine.nx & 1) != 0) hn::StoreU(hn::Zero(d), d, sums + halves - 4);
        for (int x = 0; x < coarse.nx; ++x, out += 4) {
            const float* first = sums + 4 * (2 * x + 1 - reach);
            V sum = hn::Zero(d);
            for (int i = 0; i < taps; ++i) sum = hn::MulAdd(hn::LoadU(d, first + 4 * i), hn::Set(d, weights[i]), sum);
            store(reduce(sum, filter), out);
        }
    }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
namespace {
HWY_EXPORT(reduce_slice);
HWY_EXPORT(write_slices);
}  // namespace

Pyramid build_isotropic(Coverage coverage, const IsotropicKnobs& knobs, const LitVoxels& lit) {
    const IsotropicFilter filter{coverage, knobs.kernel == "tent", knobs.format == "rgba8"};
    Pyramid pyramid = make_levels(lit.grid->domain, 1, knobs);
    const float scale = radiance_scale(lit);  // refuses what is not finite
    pyramid.scale = filter.eight_bits ? 1.0f : scale;
    const VoxelView voxels = view(lit, pyramid.scale);
    const auto reduce = [&](const LevelView& fine, const LevelView& coarse, int z) {
        thread_local std::vector<float> sums;
        sums.resize(4 * (static_cast<std::size_t>(fine.nx) + 3));
        HWY_DYNAMIC_DISPATCH(reduce_slice)(fine, coarse, z, filter, sums.data());
    };
    const LevelView finest = view(pyramid.levels[0]);
    const bool more = pyramid.levels.size() > 1;
    parallel_pieces(static_cast<std::size_t>((finest.nz + 1) / 2), [&](std::size_t piece) {
        const int z = static_cast<int>(piece);
        HWY_DYNAMIC_DISPATCH(write_slices)(finest, slices_of(voxels, pyramid.domain, z), z, filter.eight_bits);
        if (more && !filter.tent) reduce(finest, view(pyramid.levels[1]), z);
    });
    // The tent reaches into slices that other pieces write.
    if (more && filter.tent) over_slices(pyramid.levels[1], [&](int z) { reduce(finest, view(pyramid.levels[1]), z); });
    reduce_coarse(pyramid, reduce);
    pyramid.counts.voxels = lit.grid->size();
    return pyramid;
}

}  // namespace interreflect
#endif
