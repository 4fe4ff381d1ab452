#include "voxels/march/march_cones.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/march/march_cones.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Roofline. A step of one cone reads two levels: 8 loads of 16 bytes, all but the first two or three steps from cache; the
// arithmetic is 14 fused multiply-adds of 8 lanes. The loads bound it: 8 loads at 2 a cycle are 4 cycles; addresses, weights and
// blending are shared by a vector of cones, which take the same step of the same level at the same time.
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

LevelView view_of(const Pyramid& pyramid, const AirMap& air, int number) {
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

/// The octant of each direction of a vector.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_octants(D d, V dx, V dy, V dz, int* octants) {
    const hn::RebindToSigned<D> di;
    const auto bit = [&](V along, int value) HWY_ATTR {
        return hn::IfThenElseZero(hn::RebindMask(di, hn::Gt(along, hn::Zero(d))), hn::Set(di, value));
    };
    hn::Store(hn::Or(hn::Or(bit(dx, 1), bit(dy, 2)), bit(dz, 4)), di, octants);
}

/// What a cone sees of a level: its one volume, the one of its octant, or three of its six blended by the squared direction.
HWY_INLINE hn::Vec<decltype(d4)> sample(const LevelView& level, const Taps& taps, int lane, const float* direction, int octant) {
    const Half* at = level.texels + taps.offset[lane];
    if (level.faces == 8) at += level.volume * static_cast<std::size_t>(octant);
    const float fx = taps.fx[lane], fy = taps.fy[lane], fz = taps.fz[lane];
    if (level.faces != 6) return tap(at, level.row, level.slice, fx, fy, fz);
    auto sum = hn::Zero(d4);
    for (int axis = 0; axis < 3; ++axis) {
        const float along = direction[axis * ConeBatch::capacity];
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
template <class D>
HWY_INLINE void column_weights(D d, const Taps& fine, const Taps& coarse, float blend, float* weights) {
    const auto share = hn::Set(d, blend), rest = hn::Set(d, 1.0f - blend);
    const auto right0 = hn::Mul(hn::Load(d, fine.fx), rest), right1 = hn::Mul(hn::Load(d, coarse.fx), share);
    hn::StoreInterleaved4(hn::Sub(rest, right0), right0, hn::Sub(share, right1), right1, d, weights);
}
#endif

/// Distance at which rays leave the box [0, size].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exit_distance(D d, V p, V direction, float size) {
    const V zero = hn::Zero(d);
    const V to_wall = hn::Sub(hn::IfThenElseZero(hn::Gt(direction, zero), hn::Set(d, size)), p);
    const auto moves = hn::Gt(hn::Abs(direction), hn::Set(d, 1e-6f));
    return hn::IfThenElse(moves, hn::Div(to_wall, hn::IfThenElse(moves, direction, hn::Set(d, 1.0f))), hn::Set(d, 1e9f));
}

/// Integral of the tent of the trilinear filter from -infinity to x (texels).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V tent_integral(D d, V x) {
    const V one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    const V t = hn::Min(hn::Max(x, hn::Set(d, -1.0f)), one);
    const V rise = hn::Sub(one, hn::Abs(t));
    const V tail = hn::Mul(half, hn::Mul(rise, rise));
    return hn::IfThenElse(hn::Lt(t, hn::Zero(d)), tail, hn::Sub(one, tail));
}

/// What the receiver's own plane adds to a level's filtered opacity at a sample: its voxels are a layer `width` texels thick.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V own_opacity(D d, float inverse_size, V height, V width, V axis_plane, V axis_sample, V axis_cells, V aligned) {
    const V scale = hn::Set(d, inverse_size), half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const V h = hn::Mul(height, scale), reach = hn::Mul(width, half);
    const V mean = hn::Sub(tent_integral(d, hn::Add(h, reach)), tent_integral(d, hn::Sub(h, reach)));
    const V centre = hn::Add(hn::Floor(hn::Mul(axis_plane, scale)), half);
    // The border repeats the outermost texels: beyond their centres nothing changes.
    const V last = hn::Sub(hn::Ceil(hn::Mul(axis_cells, scale)), half);
    const V sample = hn::Min(hn::Max(hn::Mul(axis_sample, scale), half), last);
    const V known = hn::Max(hn::Sub(one, hn::Abs(hn::Sub(sample, centre))), zero);
    return hn::IfThenElse(hn::Gt(aligned, zero), known, mean);
}

/// Horner's rule, highest power first.
template <class D, class V = hn::Vec<D>, std::size_t n>
HWY_INLINE V polynomial(D d, V x, const float (&coefficients)[n]) {
    V sum = hn::Set(d, coefficients[0]);
    for (std::size_t i = 1; i < n; ++i) sum = hn::MulAdd(sum, x, hn::Set(d, coefficients[i]));
    return sum;
}

/// x^exponent, x in [0, 1], within 1e-6 times the exponent: opacities are half floats. Exactly 1 at 1, and 0 from 1e-12 down.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V power(D d, V x, float exponent) {
    const hn::RebindToSigned<D> di;
    // Chebyshev fits: log2(1 + t) / t for 1 + t in [sqrt(1/2), sqrt(2)], and 2^t for t in [-1/2, 1/2].
    static constexpr float log2_over_t[] = {0.172128703f, -0.269506265f, 0.295633603f, -0.359350654f,
                                            0.480629147f, -0.72136404f,  1.44269643f};
    static constexpr float exp2_of_t[] = {0.00134004322f, 0.0096760371f, 0.0555032721f, 0.240221074f, 0.693147207f, 1.0f};
    const auto bits = hn::BitCast(di, x);
    const auto whole = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));  // sqrt(1/2)
    const V t = hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(whole))), hn::Set(d, 1.0f));
    const V log2 = hn::MulAdd(t, polynomial(d, t, log2_over_t), hn::ConvertTo(d, whole));
    const V y = hn::Max(hn::Mul(log2, hn::Set(d, exponent)), hn::Set(d, -126.0f)), nearest = hn::Round(y);
    const V mantissa = polynomial(d, hn::Sub(y, nearest), exp2_of_t);
    const V result = hn::BitCast(d, hn::Add(hn::BitCast(di, mantissa), hn::ShiftLeft<23>(hn::ConvertTo(di, nearest))));
    return hn::IfThenElseZero(hn::Gt(x, hn::Set(d, 1e-12f)), result);
}

/// 1 - (1 - a)^exponent.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V stretched_opacity(D d, V a, float exponent) {
    const V one = hn::Set(d, 1.0f);
    if (exponent == 1.0f) return a;
    const V clear = hn::Sub(one, a);
    if (exponent == 0.5f) return hn::Sub(one, hn::Sqrt(clear));
    if (exponent == 2.0f) return hn::Sub(one, hn::Mul(clear, clear));
    return hn::Sub(one, power(d, clear, exponent));
}

/// How much of the cone a step newly blocks. Independent of what blocked it before, it is the step's share of what is open; fully
/// correlated (a wall along the cone covers the same part of it at every step), only what exceeds all that is blocked already.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V newly_blocked(D d, V open, V opacity, float correlation) {
    const V independent = hn::Mul(open, opacity);
    if (correlation == 0.0f) return independent;
    const V beyond = hn::Max(hn::Sub(hn::Add(open, opacity), hn::Set(d, 1.0f)), hn::Zero(d));
    return hn::MulAdd(hn::Sub(beyond, independent), hn::Set(d, correlation), independent);
}

/// What each marching cone of a vector sees at its sample: four floats a lane in `colour`. `l1`: the coarser level, or null.
template <class D>
HWY_INLINE void sample_lanes(D d, unsigned bits, const LevelView& l0, const Taps& fine, const LevelView* l1, const Taps& coarse,
                             float blend, const float* directions, const int* octants, float* colour) {
#if HWY_MAX_BYTES >= 64
    if (l1 != nullptr && l1->faces != 6) {
        alignas(64) float weights[4 * max_lanes];
        column_weights(d, fine, coarse, blend, weights);
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
        auto seen = sample(l0, fine, lane, directions + lane, octants[lane]);
        if (l1 != nullptr)
            seen = hn::MulAdd(hn::Sub(sample(*l1, coarse, lane, directions + lane, octants[lane]), seen), share, seen);
        hn::Store(seen, d4, colour + 4 * lane);
    }
}

ConeCounts march_batch(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    const hn::ScalableTag<float> d;
    using V = hn::Vec<decltype(d)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    LevelView levels[32];
    const int level_count = static_cast<int>(pyramid.levels.size());
    for (int i = 0; i < level_count; ++i) levels[i] = view_of(pyramid, air, i);
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const float sx = static_cast<float>(pyramid.domain.cells.x), sy = static_cast<float>(pyramid.domain.cells.y),
                sz = static_cast<float>(pyramid.domain.cells.z);
    ConeCounts counts;
    for (int first = 0; first < batch.count; first += lanes) {
        const V px = hn::Load(d, batch.x + first), py = hn::Load(d, batch.y + first), pz = hn::Load(d, batch.z + first);
        const V dx = hn::Load(d, batch.dx + first), dy = hn::Load(d, batch.dy + first), dz = hn::Load(d, batch.dz + first);
        const V exit = hn::Min(hn::Min(exit_distance(d, px, dx, sx), exit_distance(d, py, dy, sy)), exit_distance(d, pz, dz, sz));
        auto active = hn::FirstN(d, static_cast<std::size_t>(batch.count - first < lanes ? batch.count - first : lanes));
        const V height = hn::Load(d, batch.height + first), slope = hn::Load(d, batch.slope + first);
        const V width = hn::Load(d, batch.width + first), aligned = hn::Load(d, batch.aligned + first);
        const V axis_plane = hn::Load(d, batch.axis_plane + first), axis_start = hn::Load(d, batch.axis_start + first);
        const V axis_direction = hn::Load(d, batch.axis_direction + first), axis_cells = hn::Load(d, batch.axis_cells + first);
        const auto has_plane = hn::Gt(width, zero);
        V r = zero, g = zero, b = zero, open = one;
        alignas(64) float colour[4 * max_lanes] = {};
        alignas(64) int octants[max_lanes];
        store_octants(d, dx, dy, dz, octants);
        Taps fine, coarse;
        for (const auto& step : schedule.steps) {
            // A cone ends when its filter has left the domain; between that and its axis leaving, the border repeats the
            // outermost texels, so an outer wall closes as tightly as an inner one.
            const V distance = hn::Set(d, step.distance);
            active = hn::And(active, hn::Lt(hn::Sub(distance, hn::Set(d, step.reach)), exit));
            if (hn::AllFalse(d, active)) break;
            const auto marching = static_cast<std::uint64_t>(hn::CountTrue(d, active));
            counts.steps += marching;
            const auto inside = [&](V p, V direction, float size) HWY_ATTR {
                return hn::Min(hn::Max(hn::MulAdd(direction, distance, p), zero), hn::Set(d, size));
            };
            const V x = inside(px, dx, sx), y = inside(py, dy, sy), z = inside(pz, dz, sz);
            const LevelView& l0 = levels[step.level];
            const bool two = step.blend > 0.0f;
            const LevelView& l1 = levels[two ? step.level + 1 : step.level];
            // What is air to a coarser tap is air to the finer ones within it.
            const auto seeing = hn::And(active, place_taps(d, l1, x, y, z, coarse));
            if (hn::AllFalse(d, seeing)) continue;
            if (two) place_taps(d, l0, x, y, z, fine);
            uint8_t bytes[8] = {};
            hn::StoreMaskBits(d, seeing, bytes);
            const unsigned bits = static_cast<unsigned>(bytes[0]) | (static_cast<unsigned>(bytes[1]) << 8);
            sample_lanes(d, bits, l0, two ? fine : coarse, two ? &l1 : nullptr, coarse, step.blend, batch.dx + first, octants,
                         colour);
            counts.fetches +=
                static_cast<std::uint64_t>(hn::CountTrue(d, seeing)) * static_cast<std::uint64_t>(two ? l0.faces == 6   ? 6
                                                                                                        : l1.faces == 6 ? 4
                                                                                                                        : 2
                                                                                                      : 1);
            V tr, tg, tb, ta;
            hn::LoadInterleaved4(d, colour, tr, tg, tb, ta);
            ta = hn::IfThenElseZero(seeing, hn::Min(hn::Max(ta, zero), one));
            const V h = hn::MulAdd(slope, distance, height), along = hn::MulAdd(axis_direction, distance, axis_start);
            V own = own_opacity(d, l0.inverse_size, h, width, axis_plane, along, axis_cells, aligned);
            if (two) {
                const V next = own_opacity(d, l1.inverse_size, h, width, axis_plane, along, axis_cells, aligned);
                own = hn::MulAdd(hn::Sub(next, own), hn::Set(d, step.blend), own);
            }
            own = hn::IfThenElseZero(has_plane, own);
            const V others = hn::Div(hn::Max(hn::Sub(ta, own), zero), hn::Max(hn::Sub(one, own), hn::Set(d, 1e-3f)));
            const V opacity = hn::IfThenElseZero(seeing, stretched_opacity(d, hn::Min(others, one), step.exponent));
            const V blocked = newly_blocked(d, open, opacity, step.correlation);
            // Radiance is premultiplied by the texel's opacity; the step shows more or less of it.
            const V share = hn::Div(blocked, hn::Max(ta, hn::Set(d, 1e-6f)));
            r = hn::MulAdd(share, tr, r);
            g = hn::MulAdd(share, tg, g);
            b = hn::MulAdd(share, tb, b);
            open = hn::Sub(open, blocked);
            active = hn::And(active, hn::Ge(open, hn::Set(d, cut_off)));
        }
        const auto closed = hn::Lt(open, hn::Set(d, cut_off));
        const V whole = hn::IfThenElse(closed, hn::Div(one, hn::Sub(one, open)), one);
        hn::Store(hn::Mul(r, whole), d, batch.r + first);
        hn::Store(hn::Mul(g, whole), d, batch.g + first);
        hn::Store(hn::Mul(b, whole), d, batch.b + first);
        hn::Store(hn::IfThenElse(closed, zero, open), d, batch.open + first);
    }
    return counts;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(march_batch);

ConeCounts march_cones(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    return HWY_DYNAMIC_DISPATCH(march_batch)(pyramid, air, schedule, cut_off, batch);
}

}  // namespace interreflect
#endif
