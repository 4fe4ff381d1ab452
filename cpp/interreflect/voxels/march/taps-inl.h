// Trilinear taps of the pyramid's levels, for a vector of cones. Included once for every vector target.
#if defined(INTERREFLECT_TAPS_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_TAPS_KERNEL
#undef INTERREFLECT_TAPS_KERNEL
#else
#define INTERREFLECT_TAPS_KERNEL
#endif

#include "voxels/march/march_cones.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Half = hwy::float16_t;
const hn::FixedTag<float, 4> d4;

/// Trilinear tap: the texel pair at `p` and its neighbours one row and one slice on.
HWY_INLINE hn::Vec<decltype(d4)> tap(const Half* p, std::size_t row, std::size_t slice, float fx, float fy, float fz) {
#if HWY_MAX_BYTES >= 32
    const hn::FixedTag<float, 8> d8;
    const hn::FixedTag<Half, 8> h8;
    auto a = hn::PromoteTo(d8, hn::LoadU(h8, p)), b = hn::PromoteTo(d8, hn::LoadU(h8, p + row));
    auto c = hn::PromoteTo(d8, hn::LoadU(h8, p + slice)), d = hn::PromoteTo(d8, hn::LoadU(h8, p + slice + row));
    const auto vy = hn::Set(d8, fy), vz = hn::Set(d8, fz);
    a = hn::MulAdd(hn::Sub(b, a), vy, a);
    c = hn::MulAdd(hn::Sub(d, c), vy, c);
    a = hn::MulAdd(hn::Sub(c, a), vz, a);
    const auto low = hn::LowerHalf(d4, a), high = hn::UpperHalf(d4, a);
    return hn::MulAdd(hn::Sub(high, low), hn::Set(d4, fx), low);
#else
    const hn::FixedTag<Half, 4> h4;
    const auto vx = hn::Set(d4, fx), vy = hn::Set(d4, fy), vz = hn::Set(d4, fz);
    const auto pair = [&](const Half* q) HWY_ATTR {
        const auto left = hn::PromoteTo(d4, hn::LoadU(h4, q)), right = hn::PromoteTo(d4, hn::LoadU(h4, q + 4));
        return hn::MulAdd(hn::Sub(right, left), vx, left);
    };
    const auto a = pair(p), b = pair(p + row), c = pair(p + slice), d = pair(p + slice + row);
    const auto near = hn::MulAdd(hn::Sub(b, a), vy, a), far = hn::MulAdd(hn::Sub(d, c), vy, c);
    return hn::MulAdd(hn::Sub(far, near), vz, near);
#endif
}

/// One level as the kernel reads it: strides in halves, `texels` at texel (0, 0, 0).
struct LevelView {
    const Half* texels;
    std::size_t row, slice, volume;
    int faces;
    float inverse_size;  // texels a voxel
    const AirMap::Level* air;
};

HWY_INLINE LevelView view_of(const Pyramid& pyramid, const AirMap& air, int number) {
    const Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(number)];
    const auto* texels = reinterpret_cast<const Half*>(level.texels.data());
    return {texels + 4 * level.index(0, 0, 0),      4 * level.row(), 4 * level.slice(), 4 * level.volume(), level.faces,
            1.0f / static_cast<float>(1 << number), air.of(number)};
}

constexpr int max_lanes = HWY_MAX_BYTES / sizeof(float);

/// Where a vector of cones taps a level.
struct Taps {
    alignas(64) int offset[max_lanes];
    alignas(64) float fx[max_lanes], fy[max_lanes], fz[max_lanes];
};

/// Returns which of the taps may read something else than air.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> place_taps(D d, const LevelView& level, V x, V y, V z, Taps& taps) {
    const hn::RebindToSigned<D> di;
    const V half = hn::Set(d, -0.5f), scale = hn::Set(d, level.inverse_size);
    const V qx = hn::MulAdd(x, scale, half), qy = hn::MulAdd(y, scale, half), qz = hn::MulAdd(z, scale, half);
    const V bx = hn::Floor(qx), by = hn::Floor(qy), bz = hn::Floor(qz);
    const auto row = hn::Set(di, static_cast<int>(level.row)), slice = hn::Set(di, static_cast<int>(level.slice));
    const auto ix = hn::ConvertTo(di, bx), iy = hn::ConvertTo(di, by), iz = hn::ConvertTo(di, bz);
    const auto offset = hn::Add(hn::Add(hn::ShiftLeft<2>(ix), hn::Mul(iy, row)), hn::Mul(iz, slice));
    hn::Store(offset, di, taps.offset);
    hn::Store(hn::Sub(qx, bx), d, taps.fx);
    hn::Store(hn::Sub(qy, by), d, taps.fy);
    hn::Store(hn::Sub(qz, bz), d, taps.fz);
    if (level.air == nullptr) return hn::FirstN(d, hn::Lanes(d));
    const auto one = hn::Set(di, 1), tx = hn::Add(ix, one);
    const auto words = [&](std::uint32_t count) HWY_ATTR { return hn::Set(di, static_cast<int>(count)); };
    const auto word = hn::Add(hn::Add(hn::ShiftRight<5>(tx), hn::Mul(hn::Add(iy, one), words(level.air->row_words))),
                              hn::Mul(hn::Add(iz, one), words(level.air->slice_words)));
    const auto bits = hn::GatherIndex(di, reinterpret_cast<const int32_t*>(level.air->words.data()), word);
    const auto bit = hn::Shl(one, hn::And(tx, hn::Set(di, 31)));
    return hn::RebindMask(d, hn::Ne(hn::And(bits, bit), hn::Zero(di)));
}

/// Distance at which rays leave the box [0, size].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exit_distance(D d, V p, V direction, float size) {
    const V zero = hn::Zero(d);
    const V to_wall = hn::Sub(hn::IfThenElseZero(hn::Gt(direction, zero), hn::Set(d, size)), p);
    const auto moves = hn::Gt(hn::Abs(direction), hn::Set(d, 1e-6f));
    return hn::IfThenElse(moves, hn::Div(to_wall, hn::IfThenElse(moves, direction, hn::Set(d, 1.0f))), hn::Set(d, 1e9f));
}

/// The octant of each direction of a vector.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_octants(D d, V dx, V dy, V dz, int* octants) {
    const hn::RebindToSigned<D> di;
    const auto bit = [&](V along, int value) HWY_ATTR {
        return hn::IfThenElseZero(hn::RebindMask(di, hn::Gt(along, hn::Zero(d))), hn::Set(di, value));
    };
    hn::Store(hn::Or(hn::Or(bit(dx, 1), bit(dy, 2)), bit(dz, 4)), di, octants);
}

/// How many trilinear taps sample() takes.
HWY_INLINE std::uint64_t fetches_of(const LevelView& level) { return level.faces == 4 ? 4 : level.faces == 6 ? 3 : 1; }

/// Whether a cone reads one volume only, which sample_both can do for two levels at once.
HWY_INLINE bool one_volume(const LevelView& level) { return level.faces == 1 || level.faces == 8; }

/// What a cone sees of a level: its one volume, the one of its octant, the sum of its harmonics, or three of its six faces
/// blended by the squared direction. `direction`: x of it, then y and z `stride` floats further each.
HWY_INLINE hn::Vec<decltype(d4)> sample(const LevelView& level, const Taps& taps, int lane, const float* direction, int stride,
                                        int octant) {
    const Half* at = level.texels + taps.offset[lane];
    if (level.faces == 8) at += level.volume * static_cast<std::size_t>(octant);
    const float fx = taps.fx[lane], fy = taps.fy[lane], fz = taps.fz[lane];
    if (one_volume(level)) return tap(at, level.row, level.slice, fx, fy, fz);
    if (level.faces == 4) {
        auto seen = tap(at, level.row, level.slice, fx, fy, fz);
        for (int axis = 0; axis < 3; ++axis)
            seen = hn::MulAdd(tap(at + level.volume * static_cast<std::size_t>(axis + 1), level.row, level.slice, fx, fy, fz),
                              hn::Set(d4, direction[axis * stride]), seen);
        return hn::Max(seen, hn::Zero(d4));
    }
    auto sum = hn::Zero(d4);
    for (int axis = 0; axis < 3; ++axis) {
        const float along = direction[axis * stride];
        const Half* face = at + level.volume * static_cast<std::size_t>(2 * axis + (along > 0.0f ? 0 : 1));
        sum = hn::MulAdd(tap(face, level.row, level.slice, fx, fy, fz), hn::Set(d4, along * along), sum);
    }
    return sum;
}

#if HWY_MAX_BYTES >= 64
/// Two levels of one volume each at once, in the two halves of a vector. `weights`: of the two columns of texels of the finer
/// level and of the coarser one, blend included.
HWY_INLINE hn::Vec<decltype(d4)> sample_both(const LevelView& l0, const Taps& t0, const LevelView& l1, const Taps& t1, int lane,
                                             std::size_t octant, const float* weights) {
    const hn::FixedTag<float, 16> d16;
    const hn::FixedTag<float, 8> d8;
    const hn::FixedTag<Half, 16> h16;
    const hn::FixedTag<Half, 8> h8;
    const Half *p = l0.texels + l0.volume * octant + t0.offset[lane], *q = l1.texels + l1.volume * octant + t1.offset[lane];
    const auto load = [&](std::size_t o0, std::size_t o1)
                          HWY_ATTR { return hn::PromoteTo(d16, hn::Combine(h16, hn::LoadU(h8, q + o1), hn::LoadU(h8, p + o0))); };
    const auto vy = hn::Combine(d16, hn::Set(d8, t1.fy[lane]), hn::Set(d8, t0.fy[lane]));
    const auto vz = hn::Combine(d16, hn::Set(d8, t1.fz[lane]), hn::Set(d8, t0.fz[lane]));
    auto a = load(0, 0), b = load(l0.row, l1.row);
    auto c = load(l0.slice, l1.slice), e = load(l0.slice + l0.row, l1.slice + l1.row);
    a = hn::MulAdd(hn::Sub(b, a), vy, a);
    c = hn::MulAdd(hn::Sub(e, c), vy, c);
    a = hn::MulAdd(hn::Sub(c, a), vz, a);
    alignas(64) static constexpr int32_t spread[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    a = hn::Mul(a, hn::TableLookupLanes(hn::LoadDup128(d16, weights), hn::SetTableIndices(d16, spread)));
    const auto half = hn::Add(hn::LowerHalf(d8, a), hn::UpperHalf(d8, a));
    return hn::Add(hn::LowerHalf(d4, half), hn::UpperHalf(d4, half));
}

/// The weights of sample_both for a vector of cones.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void column_weights(D d, const Taps& fine, const Taps& coarse, V share, float* weights) {
    const auto rest = hn::Sub(hn::Set(d, 1.0f), share);
    const auto right0 = hn::Mul(hn::Load(d, fine.fx), rest), right1 = hn::Mul(hn::Load(d, coarse.fx), share);
    hn::StoreInterleaved4(hn::Sub(rest, right0), right0, hn::Sub(share, right1), right1, d, weights);
}
#endif

/// What each marching cone of a vector sees at its sample: four floats a lane in `colour`. `l1`: the coarser level, or null.
template <class D>
HWY_INLINE void sample_lanes(D d, unsigned bits, const LevelView& l0, const Taps& fine, const LevelView* l1, const Taps& coarse,
                             float blend, const float* directions, const int* octants, float* colour) {
#if HWY_MAX_BYTES >= 64
    if (l1 != nullptr && one_volume(*l1)) {
        alignas(64) float weights[4 * max_lanes];
        column_weights(d, fine, coarse, hn::Set(d, blend), weights);
        for (unsigned left = bits; left != 0; left &= left - 1) {
            const int lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
            const auto octant = static_cast<std::size_t>(l0.faces == 8 ? octants[lane] : 0);
            hn::Store(sample_both(l0, fine, *l1, coarse, lane, octant, weights + 4 * lane), d4, colour + 4 * lane);
        }
        return;
    }
#endif
    (void)d;
    const auto share = hn::Set(d4, blend);
    for (unsigned left = bits; left != 0; left &= left - 1) {
        const int lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
        auto seen = sample(l0, fine, lane, directions + lane, ConeBatch::capacity, octants[lane]);
        if (l1 != nullptr)
            seen = hn::MulAdd(hn::Sub(sample(*l1, coarse, lane, directions + lane, ConeBatch::capacity, octants[lane]), seen),
                              share, seen);
        hn::Store(seen, d4, colour + 4 * lane);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
