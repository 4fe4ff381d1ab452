#include "voxels/march/march_cones.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/march/march_cones.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

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
};

LevelView view_of(const Pyramid::Level& level, int number) {
    const auto* texels = reinterpret_cast<const Half*>(level.texels.data());
    return {texels + 4 * level.index(0, 0, 0),     4 * level.row(), 4 * level.slice(), 4 * level.volume(), level.faces,
            1.0f / static_cast<float>(1 << number)};
}

constexpr int max_lanes = HWY_MAX_BYTES / sizeof(float);

/// Where a vector of cones taps a level.
struct Taps {
    alignas(64) int offset[max_lanes];
    alignas(64) float fx[max_lanes], fy[max_lanes], fz[max_lanes];
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE void place_taps(D d, const LevelView& level, V x, V y, V z, Taps& taps) {
    const hn::RebindToSigned<D> di;
    const V half = hn::Set(d, -0.5f), scale = hn::Set(d, level.inverse_size);
    const V qx = hn::MulAdd(x, scale, half), qy = hn::MulAdd(y, scale, half), qz = hn::MulAdd(z, scale, half);
    const V bx = hn::Floor(qx), by = hn::Floor(qy), bz = hn::Floor(qz);
    const auto row = hn::Set(di, static_cast<int>(level.row)), slice = hn::Set(di, static_cast<int>(level.slice));
    const auto offset = hn::Add(hn::Add(hn::ShiftLeft<2>(hn::ConvertTo(di, bx)), hn::Mul(hn::ConvertTo(di, by), row)),
                                hn::Mul(hn::ConvertTo(di, bz), slice));
    hn::Store(offset, di, taps.offset);
    hn::Store(hn::Sub(qx, bx), d, taps.fx);
    hn::Store(hn::Sub(qy, by), d, taps.fy);
    hn::Store(hn::Sub(qz, bz), d, taps.fz);
}

/// What a cone sees of a level: its one volume, or three of its six blended by the squared direction.
HWY_INLINE hn::Vec<decltype(d4)> sample(const LevelView& level, const Taps& taps, int lane, const float* direction) {
    const Half* at = level.texels + taps.offset[lane];
    const float fx = taps.fx[lane], fy = taps.fy[lane], fz = taps.fz[lane];
    if (level.faces == 1) return tap(at, level.row, level.slice, fx, fy, fz);
    auto sum = hn::Zero(d4);
    for (int axis = 0; axis < 3; ++axis) {
        const float along = direction[axis * ConeBatch::capacity];
        const Half* face = at + level.volume * static_cast<std::size_t>(2 * axis + (along > 0.0f ? 0 : 1));
        sum = hn::MulAdd(tap(face, level.row, level.slice, fx, fy, fz), hn::Set(d4, along * along), sum);
    }
    return sum;
}

/// Distance at which rays leave the box [0, size].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exit_distance(D d, V p, V direction, float size) {
    const V zero = hn::Zero(d);
    const V to_wall = hn::Sub(hn::IfThenElseZero(hn::Gt(direction, zero), hn::Set(d, size)), p);
    const auto moves = hn::Gt(hn::Abs(direction), hn::Set(d, 1e-6f));
    return hn::IfThenElse(moves, hn::Div(to_wall, hn::IfThenElse(moves, direction, hn::Set(d, 1.0f))), hn::Set(d, 1e9f));
}

/// 1 - (1 - a)^exponent.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V stretched_opacity(D d, V a, float exponent) {
    const V one = hn::Set(d, 1.0f);
    if (exponent == 1.0f) return a;
    const V clear = hn::Sub(one, a);
    if (exponent == 0.5f) return hn::Sub(one, hn::Sqrt(clear));
    if (exponent == 2.0f) return hn::Sub(one, hn::Mul(clear, clear));
    const V floor = hn::Set(d, 1e-12f);
    const V power = hn::Exp(d, hn::Mul(hn::Set(d, exponent), hn::Log(d, hn::Max(clear, floor))));
    return hn::Sub(one, hn::IfThenElseZero(hn::Gt(clear, floor), power));
}

ConeCounts march_batch(const Pyramid& pyramid, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    const hn::ScalableTag<float> d;
    using V = hn::Vec<decltype(d)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    LevelView levels[32];
    const int level_count = static_cast<int>(pyramid.levels.size());
    for (int i = 0; i < level_count; ++i) levels[i] = view_of(pyramid.levels[i], i);
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const float sx = static_cast<float>(pyramid.domain.cells.x), sy = static_cast<float>(pyramid.domain.cells.y),
                sz = static_cast<float>(pyramid.domain.cells.z);
    ConeCounts counts;
    for (int first = 0; first < batch.count; first += lanes) {
        const V px = hn::Load(d, batch.x + first), py = hn::Load(d, batch.y + first), pz = hn::Load(d, batch.z + first);
        const V dx = hn::Load(d, batch.dx + first), dy = hn::Load(d, batch.dy + first), dz = hn::Load(d, batch.dz + first);
        const V exit = hn::Min(hn::Min(exit_distance(d, px, dx, sx), exit_distance(d, py, dy, sy)), exit_distance(d, pz, dz, sz));
        auto active = hn::FirstN(d, static_cast<std::size_t>(batch.count - first < lanes ? batch.count - first : lanes));
        V r = zero, g = zero, b = zero, open = one;
        alignas(64) float colour[4 * max_lanes] = {};
        Taps fine, coarse;
        for (const auto& step : schedule.steps) {
            // A cone ends when its filter has left the domain; between that and its axis leaving, the border repeats the
            // outermost texels, so an outer wall closes as tightly as an inner one.
            const V distance = hn::Set(d, step.distance);
            active = hn::And(active, hn::Lt(hn::Sub(distance, hn::Set(d, step.reach)), exit));
            uint8_t bytes[8] = {};
            hn::StoreMaskBits(d, active, bytes);
            unsigned bits = static_cast<unsigned>(bytes[0]) | (static_cast<unsigned>(bytes[1]) << 8);
            if (bits == 0) break;
            const auto inside = [&](V p, V direction, float size) HWY_ATTR {
                return hn::Min(hn::Max(hn::MulAdd(direction, distance, p), zero), hn::Set(d, size));
            };
            const V x = inside(px, dx, sx), y = inside(py, dy, sy), z = inside(pz, dz, sz);
            const LevelView& l0 = levels[step.level];
            const bool two = step.blend > 0.0f;
            const LevelView& l1 = levels[two ? step.level + 1 : step.level];
            place_taps(d, l0, x, y, z, fine);
            if (two) place_taps(d, l1, x, y, z, coarse);
            const auto blend = hn::Set(d4, step.blend);
            for (unsigned left = bits; left != 0; left &= left - 1) {
                const int lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
                const float* direction = batch.dx + first + lane;
                auto seen = sample(l0, fine, lane, direction);
                if (two) seen = hn::MulAdd(hn::Sub(sample(l1, coarse, lane, direction), seen), blend, seen);
                hn::Store(seen, d4, colour + 4 * lane);
            }
            const auto marching = static_cast<std::uint64_t>(hn::CountTrue(d, active));
            counts.steps += marching;
            counts.fetches += marching * static_cast<std::uint64_t>(two ? l0.faces == 6 ? 6 : l1.faces == 6 ? 4 : 2 : 1);
            V tr, tg, tb, ta;
            hn::LoadInterleaved4(d, colour, tr, tg, tb, ta);
            ta = hn::Min(hn::Max(ta, zero), one);
            const V opacity = hn::IfThenElseZero(active, stretched_opacity(d, ta, step.exponent));
            // Radiance is premultiplied by the texel's opacity; the step shows more or less of it.
            const V share = hn::Mul(open, hn::Div(opacity, hn::Max(ta, hn::Set(d, 1e-6f))));
            r = hn::MulAdd(share, tr, r);
            g = hn::MulAdd(share, tg, g);
            b = hn::MulAdd(share, tb, b);
            open = hn::Sub(open, hn::Mul(open, opacity));
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

ConeCounts march_cones(const Pyramid& pyramid, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    return HWY_DYNAMIC_DISPATCH(march_batch)(pyramid, schedule, cut_off, batch);
}

}  // namespace interreflect
#endif
