#include "voxels/march/march_cones.h"

#include <cmath>

#include "voxels/march/march_warped.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/march/march_cones.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxels/march/seen_lanes-inl.h"
#include "voxels/march/taps-inl.h"

// Roofline. A step of one cone reads two levels: 8 loads of 16 bytes, all but the first two or three steps from cache; the
// arithmetic is 14 fused multiply-adds of 8 lanes. The loads bound it: 8 loads at 2 a cycle are 4 cycles; addresses, weights and
// blending are shared by a vector of cones, which take the same step of the same level at the same time.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Where a level of a body's pyramid can be tapped: beyond that, it is air.
struct OpenLevel {
    float lower, upper_x, upper_y, upper_z;

    OpenLevel(const Pyramid& pyramid, int number) {
        const Pyramid::Level& level = pyramid.levels[static_cast<std::size_t>(number)];
        const auto texel = static_cast<float>(1 << number);
        lower = -0.5f * texel;
        upper_x = (static_cast<float>(level.size.x) + 0.4995f) * texel;
        upper_y = (static_cast<float>(level.size.y) + 0.4995f) * texel;
        upper_z = (static_cast<float>(level.size.z) + 0.4995f) * texel;
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE hn::Mask<D> holds(D d, V x, V y, V z) const {
        const V low = hn::Set(d, lower);
        const auto above = hn::And(hn::And(hn::Gt(x, low), hn::Gt(y, low)), hn::Gt(z, low));
        return hn::And(above, hn::And(hn::And(hn::Lt(x, hn::Set(d, upper_x)), hn::Lt(y, hn::Set(d, upper_y))),
                                      hn::Lt(z, hn::Set(d, upper_z))));
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE hn::Mask<D> place(D d, const LevelView& level, V x, V y, V z, Taps& taps) const {
        const V low = hn::Set(d, lower);
        const auto within = [&](V p, float upper) HWY_ATTR { return hn::Min(hn::Max(p, low), hn::Set(d, upper)); };
        return place_taps(d, level, within(x, upper_x), within(y, upper_y), within(z, upper_z), taps);
    }
};

/// `merged`: as ConeBatch has it. `body`: of a body's pyramid, whose borders are air.
template <bool merged, bool body>
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
        V entry = zero, last = exit;
        if constexpr (body) {
            const float radius = 0.5f * std::sqrt(sx * sx + sy * sy + sz * sz);
            const auto ahead = [&](V p, V direction, float size)
                                   HWY_ATTR { return hn::Mul(hn::Sub(hn::Set(d, 0.5f * size), p), direction); };
            last = hn::Add(hn::Add(hn::Add(ahead(px, dx, sx), ahead(py, dy, sy)), ahead(pz, dz, sz)), hn::Set(d, radius));
        } else if constexpr (merged) {
            entry = hn::Max(hn::Max(entry_distance(d, px, dx, sx), entry_distance(d, py, dy, sy)), entry_distance(d, pz, dz, sz));
        }
        auto active = hn::FirstN(d, static_cast<std::size_t>(batch.count - first < lanes ? batch.count - first : lanes));
        const PlaneLanes<V> plane(d, batch, first);
        SeenLanes<V> seen(d);
        alignas(64) float colour[4 * max_lanes] = {};
        alignas(64) int octants[max_lanes];
        store_octants(d, dx, dy, dz, octants);
        Taps fine, coarse;
        // A body's texels may reach beyond its domain by almost their width, and taps by half of that, at the coarser level.
        constexpr float reaches = body ? 3.0f : 1.0f;
        for (const auto& step : schedule.steps) {
            // A cone ends when its filter has left the domain; between that and its axis leaving, the border repeats the
            // outermost texels, so an outer wall closes as tightly as an inner one.
            const V distance = hn::Set(d, step.distance);
            active = hn::And(active, hn::Lt(hn::Sub(distance, hn::Set(d, reaches * step.reach)), last));
            if (batch.limited)
                active = hn::And(active, hn::Lt(hn::Add(distance, hn::Set(d, step.reach)), hn::Load(d, batch.limit + first)));
            if (hn::AllFalse(d, active)) break;
            const auto marching = static_cast<std::uint64_t>(hn::CountTrue(d, active));
            counts.steps += marching;
            const auto inside = [&](V p, V direction, float size) HWY_ATTR {
                const V at = hn::MulAdd(direction, distance, p);
                return body ? at : hn::Min(hn::Max(at, zero), hn::Set(d, size));
            };
            const V x = inside(px, dx, sx), y = inside(py, dy, sy), z = inside(pz, dz, sz);
            const LevelView& l0 = levels[step.level];
            const bool two = step.blend > 0.0f;
            const LevelView& l1 = levels[two ? step.level + 1 : step.level];
            // What is air to a coarser tap is air to the finer ones within it.
            auto seeing = active;
            if constexpr (body) {
                const OpenLevel open_level(pyramid, two ? step.level + 1 : step.level);
                seeing = hn::And(seeing, open_level.holds(d, x, y, z));
                if (hn::AllFalse(d, seeing)) continue;
                seeing = hn::And(seeing, open_level.place(d, l1, x, y, z, coarse));
                if (two) OpenLevel(pyramid, step.level).place(d, l0, x, y, z, fine);
            } else {
                if constexpr (merged) seeing = hn::And(seeing, hn::Ge(distance, entry));
                seeing = hn::And(seeing, place_taps(d, l1, x, y, z, coarse));
                if (two) place_taps(d, l0, x, y, z, fine);
            }
            if (hn::AllFalse(d, seeing)) continue;
            uint8_t bytes[8] = {};
            hn::StoreMaskBits(d, seeing, bytes);
            const unsigned bits = static_cast<unsigned>(bytes[0]) | (static_cast<unsigned>(bytes[1]) << 8);
            sample_lanes(d, bits, l0, two ? fine : coarse, two ? &l1 : nullptr, coarse, step.blend, batch.dx + first, octants,
                         colour);
            counts.fetches +=
                static_cast<std::uint64_t>(hn::CountTrue(d, seeing)) * (fetches_of(l1) + (two ? fetches_of(l0) : 0));
            V tr, tg, tb, ta;
            hn::LoadInterleaved4(d, colour, tr, tg, tb, ta);
            ta = hn::IfThenElseZero(seeing, hn::Min(hn::Max(ta, zero), one));
            const V others = plane.without(d, ta, x, y, z, hn::Set(d, l0.inverse_size), hn::Set(d, l1.inverse_size),
                                           hn::Set(d, step.blend), two);
            const V opacity = hn::IfThenElseZero(seeing, stretched_opacity(d, others, step.exponent));
            seen.add(d, tr, tg, tb, ta, newly_blocked(d, seen.open, opacity, step.correlation), distance, merged);
            active = hn::And(active, hn::Ge(seen.open, hn::Set(d, cut_off)));
        }
        seen.store(d, cut_off, first, batch);
    }
    return counts;
}

ConeCounts march_alone(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    return march_batch<false, false>(pyramid, air, schedule, cut_off, batch);
}
ConeCounts march_still(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    return march_batch<true, false>(pyramid, air, schedule, cut_off, batch);
}
ConeCounts march_body(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    return march_batch<true, true>(pyramid, air, schedule, cut_off, batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(march_alone);
HWY_EXPORT(march_still);
HWY_EXPORT(march_body);

ConeCounts march_cones(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch) {
    if (!pyramid.domain.plain()) return march_warped(pyramid, air, schedule, cut_off, batch);
    if (pyramid.pose.body != 0) return HWY_DYNAMIC_DISPATCH(march_body)(pyramid, air, schedule, cut_off, batch);
    if (batch.merged) return HWY_DYNAMIC_DISPATCH(march_still)(pyramid, air, schedule, cut_off, batch);
    return HWY_DYNAMIC_DISPATCH(march_alone)(pyramid, air, schedule, cut_off, batch);
}

}  // namespace interreflect
#endif
