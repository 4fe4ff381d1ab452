#include "voxels/march/march_warped.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/march/march_warped.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxels/march/seen_lanes-inl.h"
#include "voxels/march/taps-inl.h"
#include "voxels/march/view_lanes-inl.h"
#include "voxels/march/warp_lanes-inl.h"

// Roofline: as march_cones.cpp. Every cone of a vector has a level of its own, so addresses take three gathers from tables of a
// level's strides, and the warp a few dozen operations a vector and step.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The levels as vectors of cones read them, each cone at a level of its own.
struct LevelTable {
    static constexpr int capacity = 32;
    LevelView views[capacity];
    alignas(64) int32_t row[capacity] = {}, slice[capacity] = {};
    alignas(64) float origin_x[capacity] = {}, origin_y[capacity] = {}, origin_z[capacity] = {};
    int last;

    explicit LevelTable(const Pyramid& pyramid, const AirMap& air) : last(static_cast<int>(pyramid.levels.size()) - 1) {
        for (int i = 0; i <= last; ++i) {
            const auto& level = pyramid.levels[static_cast<std::size_t>(i)];
            views[i] = view_of(pyramid, air, i);
            row[i] = static_cast<int32_t>(views[i].row);
            slice[i] = static_cast<int32_t>(views[i].slice);
            origin_x[i] = static_cast<float>(level.origin.x);
            origin_y[i] = static_cast<float>(level.origin.y);
            origin_z[i] = static_cast<float>(level.origin.z);
        }
    }
};

/// The entry of a table of levels for each cone. A grid has 11 levels at most: one register of sixteen lanes holds them all.
template <class D, class I>
HWY_INLINE hn::Vec<D> entry(D d, const hn::TFromD<D>* table, I level) {
    if constexpr (hn::MaxLanes(D()) == 16)
        return hn::TableLookupLanes(hn::Load(d, table), hn::IndicesFromVec(d, level));
    else
        return hn::GatherIndex(d, table, level);
}

/// The first texel of each cone's tap.
template <class I>
struct FirstTexels {
    I x, y, z;
};

/// As place_in_bricks, of one tap; those of cones that see nothing may lie anywhere.
HWY_INLINE int offset_in_bricks(const LevelView& level, int x, int y, int z) {
    constexpr int side = TexelBricks::side, edge = TexelBricks::edge;
    const auto within = [](int tap, int count) HWY_ATTR { return tap < 0 ? 0 : tap < count * side ? tap : count * side - 1; };
    const int nx = level.bricks_x, ny = level.bricks_y;
    const int tx = within(x + 1, nx), ty = within(y + 1, ny), tz = within(z + 1, level.bricks_z);
    const int brick = level.bricks[tx / side + nx * (ty / side + ny * (tz / side))];
    return brick * TexelBricks::volume + tx % side + edge * (ty % side + edge * (tz % side));
}

/// Trilinear taps at `at` voxels, each of its own level; `scale`: texels a voxel there. `nested`: levels begin elsewhere than at
/// 0.
template <bool nested, class D, class I, class V = hn::Vec<D>>
HWY_INLINE FirstTexels<I> place_levels(D d, const LevelTable& table, I level, V scale, const Lanes3<V>& at, Taps& taps) {
    const hn::RebindToSigned<D> di;
    const V half = hn::Set(d, 0.5f);
    const auto place = [&](V q, const float* origins, float* fractions) HWY_ATTR {
        V texels = hn::MulSub(q, scale, half);
        if constexpr (nested) texels = hn::Sub(texels, entry(d, origins, level));
        const V first = hn::Floor(texels);
        hn::Store(hn::Sub(texels, first), d, fractions);
        return hn::ConvertTo(di, first);
    };
    const auto ix = place(at.x, table.origin_x, taps.fx), iy = place(at.y, table.origin_y, taps.fy),
               iz = place(at.z, table.origin_z, taps.fz);
    const auto rows = hn::Mul(iy, entry(di, table.row, level)), slices = hn::Mul(iz, entry(di, table.slice, level));
    hn::Store(hn::Add(hn::Add(hn::ShiftLeft<2>(ix), rows), slices), di, taps.offset);
    if (table.views[0].numbers != nullptr) {
        alignas(64) int32_t levels[max_lanes], x[max_lanes], y[max_lanes], z[max_lanes];
        hn::Store(level, di, levels);
        hn::Store(ix, di, x);
        hn::Store(iy, di, y);
        hn::Store(iz, di, z);
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
            if (const LevelView& view = table.views[levels[lane]]; view.numbers != nullptr)
                taps.offset[lane] = offset_in_bricks(view, x[lane], y[lane], z[lane]);
    }
    return {ix, iy, iz};
}

/// Which taps may read something else than air.
template <class D, class I>
HWY_INLINE hn::Mask<D> may_see(D d, const LevelTable& table, I level, const FirstTexels<I>& at) {
    const hn::RebindToSigned<D> di;
    const auto one = hn::Set(di, 1), x = hn::Add(at.x, one), y = hn::Add(at.y, one), z = hn::Add(at.z, one);
    auto air = hn::FirstN(di, 0);
    for (int k = AirMap::first_level; k <= std::min(AirMap::last_level, table.last); ++k) {
        const AirMap::Level* map = table.views[k].air;
        const auto here = hn::Eq(level, hn::Set(di, k));
        if (map == nullptr || hn::AllFalse(di, here)) continue;
        const auto words = [&](std::uint32_t count) HWY_ATTR { return hn::Set(di, static_cast<int>(count)); };
        const auto word =
            hn::Add(hn::Add(hn::ShiftRight<5>(x), hn::Mul(y, words(map->row_words))), hn::Mul(z, words(map->slice_words)));
        const auto bits =
            hn::GatherIndex(di, reinterpret_cast<const int32_t*>(map->words.data()), hn::IfThenElseZero(here, word));
        const auto bit = hn::Shl(one, hn::And(x, hn::Set(di, 31)));
        air = hn::Or(air, hn::And(here, hn::Eq(hn::And(bits, bit), hn::Zero(di))));
    }
    return hn::RebindMask(d, hn::Not(air));
}

/// What a step of a vector of cones sees.
struct Sight {
    alignas(64) float colour[4 * max_lanes] = {}, toward[3 * max_lanes], blend[max_lanes];
    alignas(64) int32_t level[max_lanes];
    alignas(64) int octant[max_lanes];
    Taps fine, coarse;
};

HWY_INLINE void look(const LevelTable& table, unsigned bits, Sight& s) {
    const auto level_of = [&](int number) HWY_ATTR -> const LevelView& { return table.views[number]; };
#if HWY_MAX_BYTES >= 64
    if (one_volume(table.views[table.last])) {
        const hn::ScalableTag<float> d;
        alignas(64) float weights[4 * max_lanes];
        column_weights(d, s.fine, s.coarse, hn::Load(d, s.blend), weights);
        for (unsigned left = bits; left != 0; left &= left - 1) {
            const int lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left)), level = s.level[lane];
            const LevelView& fine = level_of(level);
            const auto octant = static_cast<std::size_t>(fine.faces == 8 ? s.octant[lane] : 0);
            const auto seen =
                sample_both(fine, s.fine, level_of(std::min(level + 1, table.last)), s.coarse, lane, octant, weights + 4 * lane);
            hn::Store(seen, d4, s.colour + 4 * lane);
        }
        return;
    }
#endif
    for (unsigned left = bits; left != 0; left &= left - 1) {
        const int lane = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left)), level = s.level[lane];
        auto seen = sample(level_of(level), s.fine, lane, s.toward + lane, max_lanes, s.octant[lane]);
        if (s.blend[lane] > 0.0f)
            seen = hn::MulAdd(hn::Sub(sample(level_of(std::min(level + 1, table.last)), s.coarse, lane, s.toward + lane,
                                             max_lanes, s.octant[lane]),
                                      seen),
                              hn::Set(d4, s.blend[lane]), seen);
        hn::Store(seen, d4, s.colour + 4 * lane);
    }
}

/// The cones [first, first + lanes) of a batch.
template <class Map>
ConeCounts march_vector(const Map& map, const LevelTable& table, const ConeSchedule& schedule, float cut_off, ConeBatch& batch,
                        int first) {
    const hn::ScalableTag<float> d;
    const hn::RebindToSigned<decltype(d)> di;
    using V = hn::Vec<decltype(d)>;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Lanes3<V> start{hn::Load(d, batch.x + first), hn::Load(d, batch.y + first), hn::Load(d, batch.z + first)};
    const Lanes3<V> direction{hn::Load(d, batch.dx + first), hn::Load(d, batch.dy + first), hn::Load(d, batch.dz + first)};
    const V scale = hn::Load(d, batch.scale + first);
    const PlaneLanes<V> plane(d, batch, first);
    const V exit = map.exit(d, start, direction);
    const V limit = batch.limited ? hn::Load(d, batch.limit + first) : hn::Set(d, 1e30f);
    const bool harmonics = table.views[table.last].faces == 4;  // of directions in the world
    auto active = hn::FirstN(d, static_cast<std::size_t>(std::min(batch.count - first, lanes)));
    SeenLanes<V> seen(d);
    ConeCounts counts;
    Sight sight;
    for (const auto& step : schedule.steps) {
        const V distance = hn::Mul(scale, hn::Set(d, step.distance));
        const auto at = map.at(d, start, direction, distance);
        // The start's scale turns the table's level into one of the finest voxels there; the density here, into one of ours.
        const V wanted = hn::Add(hn::Set(d, step.lod), log2_of(d, hn::Mul(scale, at.density)));
        const V lod = hn::Min(hn::Max(wanted, at.least_level), hn::Set(d, static_cast<float>(table.last)));
        const V whole = hn::Floor(lod), blend = hn::Sub(lod, whole);
        const V size = exp2_of(d, lod);  // of a texel, voxels
        const V reach = hn::Div(size, hn::Max(at.stretch, hn::Set(d, 1e-20f)));
        const V sees_until = Map::view_volume ? exit : hn::Add(exit, reach);
        active = hn::And(active, hn::And(hn::Lt(distance, sees_until), hn::Lt(hn::Add(distance, reach), limit)));
        if (hn::AllFalse(d, active)) break;
        counts.steps += static_cast<std::uint64_t>(hn::CountTrue(d, active));
        const auto level = hn::ConvertTo(di, whole), last = hn::Set(di, table.last);
        const V texels = hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(di, 127), level)));  // 2^-level
        const V next_texels = hn::Mul(texels, hn::Set(d, 0.5f));
        const auto next = hn::Min(hn::Add(level, hn::Set(di, 1)), last);
        // What is air to a coarser tap is air to the finer ones within it.
        const auto first_texels = place_levels<Map::nested>(d, table, next, next_texels, at.voxels, sight.coarse);
        const auto seeing = hn::And(hn::And(active, at.inside), may_see(d, table, next, first_texels));
        if (hn::AllFalse(d, seeing)) continue;
        place_levels<Map::nested>(d, table, level, texels, at.voxels, sight.fine);
        hn::Store(level, di, sight.level);
        hn::Store(blend, d, sight.blend);
        const Lanes3<V>& seen_along = harmonics ? direction : at.toward;
        hn::Store(seen_along.x, d, sight.toward);
        hn::Store(seen_along.y, d, sight.toward + max_lanes);
        hn::Store(seen_along.z, d, sight.toward + 2 * max_lanes);
        store_octants(d, at.toward.x, at.toward.y, at.toward.z, sight.octant);
        uint8_t bytes[8] = {};
        hn::StoreMaskBits(d, seeing, bytes);
        look(table, static_cast<unsigned>(bytes[0]) | (static_cast<unsigned>(bytes[1]) << 8), sight);
        counts.fetches += 2 * static_cast<std::uint64_t>(hn::CountTrue(d, seeing)) * fetches_of(table.views[table.last]);

        V tr, tg, tb, ta;
        hn::LoadInterleaved4(d, sight.colour, tr, tg, tb, ta);
        ta = hn::IfThenElseZero(seeing, hn::Min(hn::Max(ta, zero), one));
        const V others = plane.without(d, ta, at.voxels.x, at.voxels.y, at.voxels.z, texels, next_texels, blend, /*two=*/true);
        const V density = hn::Set(d, step.density);
        const V depth = schedule.opacity_correction ? hn::Div(hn::Mul(hn::Mul(density, scale), at.stretch), size) : density;
        const V clear = power(d, hn::Sub(one, others), depth);
        const V opacity = hn::IfThenElseZero(seeing, hn::Sub(one, clear));
        seen.add(d, tr, tg, tb, ta, newly_blocked(d, seen.open, opacity, step.correlation), distance, batch.merged);
        active = hn::And(active, hn::Ge(seen.open, hn::Set(d, cut_off)));
    }
    seen.store(d, cut_off, first, batch);
    return counts;
}

template <class Map>
ConeCounts march_all(const Map& map, const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off,
                     ConeBatch& batch) {
    const LevelTable table(pyramid, air);
    const int lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
    ConeCounts counts;
    for (int first = 0; first < batch.count; first += lanes) {
        const ConeCounts done = march_vector(map, table, schedule, cut_off, batch, first);
        counts.steps += done.steps, counts.fetches += done.fetches;
    }
    return counts;
}

ConeCounts march_by_kind(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off,
                         ConeBatch& batch) {
    return with_lanes(pyramid.domain, [&](const auto& map) { return march_all(map, pyramid, air, schedule, cut_off, batch); });
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(march_by_kind);

ConeCounts march_warped(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off,
                        ConeBatch& batch) {
    return HWY_DYNAMIC_DISPATCH(march_by_kind)(pyramid, air, schedule, cut_off, batch);
}

}  // namespace interreflect
#endif
