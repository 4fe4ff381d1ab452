// Vectors of pixels between texels of a light map, or between cells of a grid. Included once for every vector target.
#if defined(INTERREFLECT_CELL_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_CELL_LANES
#undef INTERREFLECT_CELL_LANES
#else
#define INTERREFLECT_CELL_LANES
#endif

#include <algorithm>

#include "math/lanes-inl.h"
#include "surfels/evaluate/cache_finder.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Whole = hn::RebindToSigned<Tag>;
using Index = hn::Vec<Whole>;
constexpr std::size_t lanes = hn::MaxLanes(Tag());

/// Slots of a vector of pixels.
struct Slots {
    Index cache[NearCaches::level_slots];
    Vector weight[NearCaches::level_slots], sum;

    HWY_INLINE Slots() {
        for (int k = 0; k < NearCaches::level_slots; ++k) set_empty(k);
        sum = hn::Zero(Tag());
    }

    HWY_INLINE void set_empty(int slot) { cache[slot] = hn::Zero(Whole()), weight[slot] = hn::Zero(Tag()); }
    HWY_INLINE void scale(Vector by) {
        for (Vector& one : weight) one = hn::Mul(one, by);
        sum = hn::Mul(sum, by);
    }
    /// What others have in the lanes of the mask.
    HWY_INLINE void take(LaneMask mask, const Slots& from) {
        const auto whole = hn::RebindMask(Whole(), mask);
        for (int k = 0; k < NearCaches::level_slots; ++k) {
            cache[k] = hn::IfThenElse(whole, from.cache[k], cache[k]);
            weight[k] = hn::IfThenElse(mask, from.weight[k], weight[k]);
        }
        sum = hn::IfThenElse(mask, from.sum, sum);
    }
    HWY_INLINE void set(int slot, Index number, Vector by) { cache[slot] = number, weight[slot] = by, sum = hn::Add(sum, by); }
    HWY_INLINE void store(int first_slot, std::size_t at, NearCaches& near) const {
        for (int k = 0; k < NearCaches::level_slots; ++k) {
            hn::Store(cache[k], Whole(), reinterpret_cast<std::int32_t*>(near.cache[first_slot + k] + at));
            hn::Store(weight[k], Tag(), near.weight[first_slot + k] + at);
        }
    }
};

/// 1 / x; 0 where x is not above 0.
HWY_INLINE Vector inverse(Vector x) {
    const Tag d;
    const Vector one = hn::Set(d, 1.0f);
    const auto above = hn::Gt(x, hn::Zero(d));
    return hn::IfThenElseZero(above, hn::Div(one, hn::IfThenElse(above, x, one)));
}

/// Calls take(lanes, number) for every number that some lane of `at` has. Pixels side by side lie in few cells: what a cell lists
/// is read once for all of them, where a gather reads it for each.
template <class M, class Take>
HWY_INLINE void for_each_distinct(M at, Index number, const Take& take) {
    const Whole di;
    alignas(64) std::int32_t numbers[lanes];
    hn::Store(number, di, numbers);
    while (!hn::AllFalse(di, at)) {
        const std::int32_t one = numbers[hn::FindKnownFirstTrue(di, at)];
        const auto same = hn::And(at, hn::Eq(number, hn::Set(di, one)));
        take(same, one);
        at = hn::AndNot(same, at);
    }
}

/// A cache that exists, and its weight; else 0.
HWY_INLINE void add(Slots& slots, int slot, Index cache, Vector weight) {
    const Tag d;
    const Whole di;
    const auto exists = hn::Gt(cache, hn::Set(di, -1));
    slots.set(slot, hn::IfThenElseZero(exists, cache), hn::IfThenElseZero(hn::RebindMask(d, exists), weight));
}

/// One of two neighbours' weights along an axis.
HWY_INLINE Vector part(Vector share, int step) { return step != 0 ? share : hn::Sub(hn::Set(Tag(), 1.0f), share); }

/// Bilinear between the texels about (u, v) where `mapped` holds.
HWY_INLINE Slots in_map(const LightMapSites& map, LaneMask mapped, Vector u, Vector v) {
    const Tag d;
    const Whole di;
    const Vector half = hn::Set(d, 0.5f);
    u = hn::Sub(u, half), v = hn::Sub(v, half);
    const Vector left = hn::Floor(u), top = hn::Floor(v), across = hn::Sub(u, left), down = hn::Sub(v, top);
    const Index size = hn::Set(di, map.size), x0 = hn::ConvertTo(di, left), y0 = hn::ConvertTo(di, top);
    // From the corner (-1, -1) on: look-ups reach half a texel beyond the map; slivers' planes, as rounded, may reach further.
    const Vector first = hn::Set(d, -1.0f), end = hn::Set(d, static_cast<float>(map.size));
    const auto near_map = hn::And(hn::And(hn::Ge(left, first), hn::Ge(top, first)), hn::And(hn::Lt(left, end), hn::Lt(top, end)));
    const Index one = hn::Set(di, 1), square = hn::Add(hn::Mul(hn::Add(y0, one), hn::Add(size, one)), hn::Add(x0, one));
    Index texel[4] = {hn::Set(di, -1), hn::Set(di, -1), hn::Set(di, -1), hn::Set(di, -1)};
    for_each_distinct(hn::RebindMask(di, hn::And(mapped, near_map)), square, [&](auto same, std::int32_t number) HWY_ATTR {
        for (int k = 0; k < 4; ++k) {
            const int x = number % (map.size + 1) - 1 + (k & 1), y = number / (map.size + 1) - 1 + (k >> 1);
            if (x < 0 || y < 0 || x >= map.size || y >= map.size) continue;
            const std::uint32_t cache =
                map.cache[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.size) + static_cast<std::size_t>(x)];
            texel[k] = hn::IfThenElse(same, hn::Set(di, static_cast<std::int32_t>(cache)), texel[k]);
        }
    });
    Slots slots;
    for (int k = 0; k < 4; ++k) add(slots, k, texel[k], hn::Mul(part(across, k & 1), part(down, k >> 1)));
    return slots;
}

/// A coordinate among the middles of cells: the lower neighbour's number, and the share of the upper one.
struct Between {
    Index low;
    Vector share;

    /// offset: cells added to the position.
    HWY_INLINE Between(Vector position, float lower, float upper, int cells, Vector offset) {
        const Tag d;
        const Whole di;
        const Vector size = hn::Set(d, std::max(upper - lower, 1e-30f)), count = hn::Set(d, static_cast<float>(cells));
        const Vector at =
            hn::MulAdd(hn::Div(hn::Sub(position, hn::Set(d, lower)), size), count, hn::Sub(offset, hn::Set(d, 0.5f)));
        const Vector inside = hn::Min(hn::Max(at, hn::Zero(d)), hn::Set(d, static_cast<float>(cells - 1)));
        low = hn::Min(hn::ConvertTo(di, inside), hn::Set(di, std::max(cells - 2, 0)));
        share = hn::Sub(inside, hn::ConvertTo(d, low));
    }
};

/// Trilinear between the cells about a position where `hit` holds; where all of them are missing, the nearest cell's stand-in.
HWY_INLINE Slots in_level(const GridSites& grid, int level, LaneMask hit, const Vec3& position, const Vec3& normal) {
    const Tag d;
    const Whole di;
    const vec3 &lower = grid.box.lower, &upper = grid.box.upper;
    const ivec3 size = grid.size_of(level);
    const std::size_t first_cell = grid.first_of(level);
    const std::uint32_t *const caches = grid.cache.data() + first_cell, *const nearest_of = grid.nearest.data() + first_cell;
    const Vec3 offset = scaled(normal, hn::Set(d, grid.normal_offset));
    const Between x(position.x, lower.x, upper.x, size.x, offset.x), y(position.y, lower.y, upper.y, size.y, offset.y),
        z(position.z, lower.z, upper.z, size.z, offset.z);
    const Index lowest = hn::Add(hn::Mul(hn::Add(hn::Mul(z.low, hn::Set(di, size.y)), y.low), hn::Set(di, size.x)), x.low);
    int corners = 0, place[NearCaches::level_slots];  // cells from the lowest one on
    Vector weight[NearCaches::level_slots];
    for (int k = 0; k < NearCaches::level_slots; ++k) {
        const int i = k & 1, j = (k >> 1) & 1, l = k >> 2;
        if (i >= size.x || j >= size.y || l >= size.z) continue;
        place[corners] = (l * size.y + j) * size.x + i;
        weight[corners++] = hn::Mul(hn::Mul(part(x.share, i), part(y.share, j)), part(z.share, l));
    }
    const auto within = hn::RebindMask(di, hit);
    Index cache[NearCaches::level_slots];
    for (int k = 0; k < corners; ++k) cache[k] = hn::Set(di, -1);
    for_each_distinct(within, lowest, [&](auto same, std::int32_t first) HWY_ATTR {
        for (int k = 0; k < corners; ++k)
            cache[k] = hn::IfThenElse(same, hn::Set(di, static_cast<std::int32_t>(caches[first + place[k]])), cache[k]);
    });
    Slots slots;
    for (int k = 0; k < corners; ++k) add(slots, k, cache[k], weight[k]);
    const auto none = hn::And(hn::Eq(slots.sum, hn::Zero(d)), hit);
    if (hn::AllFalse(d, none)) return slots;
    Vector most = weight[0];
    Index nearest = lowest;
    for (int k = 1; k < corners; ++k) {
        const auto more = hn::Gt(weight[k], most);
        most = hn::Max(most, weight[k]);
        nearest = hn::IfThenElse(hn::RebindMask(di, more), hn::Add(lowest, hn::Set(di, place[k])), nearest);
    }
    const auto alone = hn::RebindMask(di, none);
    Slots instead;
    for_each_distinct(alone, nearest, [&](auto same, std::int32_t cell) HWY_ATTR {
        const auto stand_in = static_cast<std::int32_t>(nearest_of[cell]);
        cache[0] = hn::IfThenElse(same, hn::Set(di, stand_in), cache[0]);
    });
    add(instead, 0, hn::IfThenElse(alone, cache[0], hn::Set(di, -1)), hn::Set(d, 1.0f));
    slots.take(none, instead);
    return slots;
}

/// Slots of even and of odd levels: no pixel reads more than two levels, side by side. `distance`: from the camera.
struct LevelSlots {
    Slots half[2];

    HWY_INLINE LevelSlots(const GridSites& grid, LaneMask hit, const Vec3& position, const Vec3& normal, Vector distance) {
        const Tag d;
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        constexpr float fade = 0.2f;  // of a level's reach
        Vector beyond = one;
        for (int level = 0; level < grid.levels; ++level) {
            const float end = grid.reach * static_cast<float>(1 << level);
            const Vector into = hn::Mul(hn::Sub(distance, hn::Set(d, (1.0f - fade) * end)), hn::Set(d, 1.0f / (fade * end)));
            const Vector next = level + 1 < grid.levels ? hn::Min(hn::Max(into, zero), one) : zero;
            const Vector share = hn::Sub(beyond, next);
            beyond = next;
            const auto here = hn::And(hit, hn::Gt(share, zero));
            if (hn::AllFalse(d, here)) continue;
            Slots found = in_level(grid, level, here, position, normal);
            found.scale(hn::Mul(share, inverse(found.sum)));
            half[level & 1].take(here, found);
        }
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
