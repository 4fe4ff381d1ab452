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

/// The texels of one volume that a tap of a dense level reads, along x, y and z.
struct DenseTexels {
    const Half* first;
    std::size_t row, slice;

    HWY_INLINE hn::Vec<hn::FixedTag<Half, 4>> texel(std::size_t x, std::size_t y, std::size_t z) const {
        return hn::LoadU(hn::FixedTag<Half, 4>(), first + 4 * x + y * row + z * slice);
    }
    /// Two neighbours in x.
    HWY_INLINE hn::Vec<hn::FixedTag<Half, 8>> pair(std::size_t y, std::size_t z) const {
        return hn::LoadU(hn::FixedTag<Half, 8>(), first + y * row + z * slice);
    }
};

/// And of a level in bricks.
struct BrickTexels {
    const Half* texels;
    const std::uint32_t* number;  // of the first

    HWY_INLINE hn::Vec<hn::FixedTag<Half, 4>> texel(std::size_t x, std::size_t y, std::size_t z) const {
        constexpr std::size_t edge = TexelBricks::edge;
        return hn::LoadU(hn::FixedTag<Half, 4>(), texels + 4 * static_cast<std::size_t>(number[x + edge * (y + edge * z)]));
    }
    HWY_INLINE hn::Vec<hn::FixedTag<Half, 8>> pair(std::size_t y, std::size_t z) const {
        return hn::Combine(hn::FixedTag<Half, 8>(), texel(1, y, z), texel(0, y, z));
    }
};

/// Trilinear tap.
template <class Texels>
HWY_INLINE hn::Vec<decltype(d4)> tap(const Texels& t, float fx, float fy, float fz) {
#if HWY_MAX_BYTES >= 32
    const hn::FixedTag<float, 8> d8;
    auto a = hn::PromoteTo(d8, t.pair(0, 0)), b = hn::PromoteTo(d8, t.pair(1, 0));
    auto c = hn::PromoteTo(d8, t.pair(0, 1)), d = hn::PromoteTo(d8, t.pair(1, 1));
    const auto vy = hn::Set(d8, fy), vz = hn::Set(d8, fz);
    a = hn::MulAdd(hn::Sub(b, a), vy, a);
    c = hn::MulAdd(hn::Sub(d, c), vy, c);
    a = hn::MulAdd(hn::Sub(c, a), vz, a);
    const auto low = hn::LowerHalf(d4, a), high = hn::UpperHalf(d4, a);
    return hn::MulAdd(hn::Sub(high, low), hn::Set(d4, fx), low);
#else
    const auto vx = hn::Set(d4, fx), vy = hn::Set(d4, fy), vz = hn::Set(d4, fz);
    const auto pair = [&](std::size_t y, std::size_t z) HWY_ATTR {
        const auto left = hn::PromoteTo(d4, t.texel(0, y, z)), right = hn::PromoteTo(d4, t.texel(1, y, z));
        return hn::MulAdd(hn::Sub(right, left), vx, left);
    };
    const auto a = pair(0, 0), b = pair(1, 0), c = pair(0, 1), d = pair(1, 1);
    const auto near = hn::MulAdd(hn::Sub(b, a), vy, a), far = hn::MulAdd(hn::Sub(d, c), vy, c);
    return hn::MulAdd(hn::Sub(far, near), vz, near);
#endif
}

/// One level as the kernel reads it: strides in halves. Dense, `texels` is at texel (0, 0, 0); in bricks, at the one of air.
struct LevelView {
    const Half* texels;
    std::size_t row, slice, volume;
    int faces;
    float inverse_size;  // texels a voxel
    const AirMap::Level* air;
    const std::uint32_t* numbers;  // of the texels of bricks; null: dense
    const int32_t* bricks;
    int bricks_x, bricks_y, bricks_z;

    HWY_INLINE DenseTexels dense_at(int offset, std::size_t face) const { return {texels + face * volume + offset, row, slice}; }
    HWY_INLINE BrickTexels brick_at(int offset, std::size_t face) const { return {texels + face * volume, numbers + offset}; }
};

HWY_INLINE LevelView view_of(const Pyramid& pyramid, const AirMap& air, int number) {
    const Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(number)];
    const auto* texels = reinterpret_cast<const Half*>(level.texels.data());
    return {level.dense() ? texels + 4 * level.index(0, 0, 0) : texels,
            4 * level.row(),
            4 * level.slice(),
            4 * level.volume(),
            level.faces,
            1.0f / static_cast<float>(1 << number),
            air.of(number),
            level.dense() ? nullptr : level.bricks.texel.data(),
            level.bricks.brick.data(),
            level.bricks.count.x,
            level.bricks.count.y,
            level.bricks.count.z};
}

constexpr int max_lanes = HWY_MAX_BYTES / sizeof(float);

/// Where a vector of cones taps a level: halves from `texels`, or in bricks the first of `numbers`.
struct Taps {
    alignas(64) int offset[max_lanes];
    alignas(64) float fx[max_lanes], fy[max_lanes], fz[max_lanes];
};

/// Finds the bricks of the taps whose first texels are given. Returns which are not all air.
template <class D, class I>
HWY_INLINE hn::Mask<D> place_in_bricks(D d, const LevelView& level, I ix, I iy, I iz, Taps& taps) {
    const hn::RebindToSigned<D> di;
    const auto one = hn::Set(di, 1), within = hn::Set(di, TexelBricks::side - 1);
    const auto tx = hn::Add(ix, one), ty = hn::Add(iy, one), tz = hn::Add(iz, one);
    const auto times = [&](I value, int factor) HWY_ATTR { return hn::Mul(value, hn::Set(di, factor)); };
    static_assert(TexelBricks::side == 4);
    const auto place = hn::Add(hn::Add(hn::ShiftRight<2>(tx), times(hn::ShiftRight<2>(ty), level.bricks_x)),
                               times(hn::ShiftRight<2>(tz), level.bricks_x * level.bricks_y));
    const auto brick = hn::GatherIndex(di, level.bricks, place);
    const auto local = hn::Add(hn::Add(hn::And(tx, within), times(hn::And(ty, within), TexelBricks::edge)),
                               times(hn::And(tz, within), TexelBricks::edge * TexelBricks::edge));
    hn::Store(hn::Add(times(brick, TexelBricks::volume), local), di, taps.offset);
    return hn::RebindMask(d, hn::Ne(brick, hn::Zero(di)));
}

/// Returns which of the taps may read something else than air.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Mask<D> place_taps(D d, const LevelView& level, V x, V y, V z, Taps& taps) {
    const hn::RebindToSigned<D> di;
    const V half = hn::Set(d, -0.5f), scale = hn::Set(d, level.inverse_size);
    const V qx = hn::MulAdd(x, scale, half), qy = hn::MulAdd(y, scale, half), qz = hn::MulAdd(z, scale, half);
    const V bx = hn::Floor(qx), by = hn::Floor(qy), bz = hn::Floor(qz);
    const auto row = hn::Set(di, static_cast<int>(level.row)), slice = hn::Set(di, static_cast<int>(level.slice));
    const auto ix = hn::ConvertTo(di, bx), iy = hn::ConvertTo(di, by), iz = hn::ConvertTo(di, bz);
    hn::Store(hn::Sub(qx, bx), d, taps.fx);
    hn::Store(hn::Sub(qy, by), d, taps.fy);
    hn::Store(hn::Sub(qz, bz), d, taps.fz);
    if (level.numbers != nullptr) return place_in_bricks(d, level, ix, iy, iz, taps);
    const auto offset = hn::Add(hn::Add(hn::ShiftLeft<2>(ix), hn::Mul(iy, row)), hn::Mul(iz, slice));
    hn::Store(offset, di, taps.offset);
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

/// Distance at which rays come into the box [0, size] along one axis; beyond everything where they never do.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V entry_distance(D d, V p, V direction, float size) {
    const V zero = hn::Zero(d), far = hn::Set(d, size);
    const V to_wall = hn::Sub(hn::IfThenElse(hn::Gt(direction, zero), zero, far), p);
    const auto moves = hn::Gt(hn::Abs(direction), hn::Set(d, 1e-6f)), within = hn::And(hn::Ge(p, zero), hn::Le(p, far));
    return hn::IfThenElse(moves, hn::Div(to_wall, hn::IfThenElse(moves, direction, hn::Set(d, 1.0f))),
                          hn::IfThenElse(within, zero, hn::Set(d, 1e9f)));
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
/// blended by the squared direction. `texels(face)`: those of a volume. `direction`: x of it, then y and z `stride` floats
/// further each.
template <class TexelsOf>
HWY_INLINE hn::Vec<decltype(d4)> sample_texels(const LevelView& level, const TexelsOf& texels, float fx, float fy, float fz,
                                               const float* direction, int stride, int octant) {
    if (one_volume(level)) return tap(texels(static_cast<std::size_t>(level.faces == 8 ? octant : 0)), fx, fy, fz);
    if (level.faces == 4) {
        auto seen = tap(texels(0), fx, fy, fz);
        for (std::size_t axis = 0; axis < 3; ++axis, direction += stride)
            seen = hn::MulAdd(tap(texels(axis + 1), fx, fy, fz), hn::Set(d4, *direction), seen);
        return hn::Max(seen, hn::Zero(d4));
    }
    auto sum = hn::Zero(d4);
    for (std::size_t axis = 0; axis < 3; ++axis, direction += stride) {
        const float along = *direction;
        const std::size_t face = 2 * axis + (along > 0.0f ? 0 : 1);
        sum = hn::MulAdd(tap(texels(face), fx, fy, fz), hn::Set(d4, along * along), sum);
    }
    return sum;
}

HWY_INLINE hn::Vec<decltype(d4)> sample(const LevelView& level, const Taps& taps, int lane, const float* direction, int stride,
                                        int octant) {
    const int offset = taps.offset[lane];
    const float fx = taps.fx[lane], fy = taps.fy[lane], fz = taps.fz[lane];
    const auto dense = [&](std::size_t face) HWY_ATTR { return level.dense_at(offset, face); };
    const auto bricks = [&](std::size_t face) HWY_ATTR { return level.brick_at(offset, face); };
    return level.numbers == nullptr ? sample_texels(level, dense, fx, fy, fz, direction, stride, octant)
                                    : sample_texels(level, bricks, fx, fy, fz, direction, stride, octant);
}

#if HWY_MAX_BYTES >= 64
/// Two taps of one volume each at once, in the two halves of a vector. `weights`: of the two columns of texels of the finer level
/// and of the coarser one, blend included.
template <class Fine, class Coarse>
HWY_INLINE hn::Vec<decltype(d4)> tap_both(const Fine& fine, const Taps& t0, const Coarse& coarse, const Taps& t1, int lane,
                                          const float* weights) {
    const hn::FixedTag<float, 16> d16;
    const hn::FixedTag<float, 8> d8;
    const hn::FixedTag<Half, 16> h16;
    const auto load = [&](std::size_t y, std::size_t z)
                          HWY_ATTR { return hn::PromoteTo(d16, hn::Combine(h16, coarse.pair(y, z), fine.pair(y, z))); };
    const auto vy = hn::Combine(d16, hn::Set(d8, t1.fy[lane]), hn::Set(d8, t0.fy[lane]));
    const auto vz = hn::Combine(d16, hn::Set(d8, t1.fz[lane]), hn::Set(d8, t0.fz[lane]));
    auto a = load(0, 0), b = load(1, 0);
    auto c = load(0, 1), e = load(1, 1);
    a = hn::MulAdd(hn::Sub(b, a), vy, a);
    c = hn::MulAdd(hn::Sub(e, c), vy, c);
    a = hn::MulAdd(hn::Sub(c, a), vz, a);
    alignas(64) static constexpr int32_t spread[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
    a = hn::Mul(a, hn::TableLookupLanes(hn::LoadDup128(d16, weights), hn::SetTableIndices(d16, spread)));
    const auto half = hn::Add(hn::LowerHalf(d8, a), hn::UpperHalf(d8, a));
    return hn::Add(hn::LowerHalf(d4, half), hn::UpperHalf(d4, half));
}

/// Two levels of one volume each at once. Levels in bricks are the finer ones.
HWY_INLINE hn::Vec<decltype(d4)> sample_both(const LevelView& l0, const Taps& t0, const LevelView& l1, const Taps& t1, int lane,
                                             std::size_t octant, const float* weights) {
    const int o0 = t0.offset[lane], o1 = t1.offset[lane];
    if (l0.numbers == nullptr) return tap_both(l0.dense_at(o0, octant), t0, l1.dense_at(o1, octant), t1, lane, weights);
    if (l1.numbers == nullptr) return tap_both(l0.brick_at(o0, octant), t0, l1.dense_at(o1, octant), t1, lane, weights);
    return tap_both(l0.brick_at(o0, octant), t0, l1.brick_at(o1, octant), t1, lane, weights);
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
