#include "surfels/evaluate/cache_finder.h"

#include <algorithm>
#include <stdexcept>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfels/evaluate/cache_finder.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline: of each pixel position, geometric normal, triangle and instance, 32 bytes, are read once. A pixel's triangle takes
// four multiply-adds of four lanes, which texels or cells lie about it some 40 or 100 operations of one lane; a vector's few
// distinct cells take 4 or 8 loads each.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Whole = hn::RebindToSigned<Tag>;
using Index = hn::Vec<Whole>;
constexpr std::size_t lanes = hn::MaxLanes(Tag());

/// Slots of a vector of pixels.
struct Slots {
    Index cache[NearCaches::slots];
    Vector weight[NearCaches::slots], sum;

    HWY_INLINE Slots() {
        for (int k = 0; k < NearCaches::slots; ++k) set_empty(k);
        sum = hn::Zero(Tag());
    }

    HWY_INLINE void set_empty(int slot) { cache[slot] = hn::Zero(Whole()), weight[slot] = hn::Zero(Tag()); }
    HWY_INLINE void set(int slot, Index number, Vector by) { cache[slot] = number, weight[slot] = by, sum = hn::Add(sum, by); }
    /// So that the weights sum up to 1.
    HWY_INLINE void store(int slots, std::size_t at, NearCaches& near) const {
        const Tag d;
        const Vector one = hn::Set(d, 1.0f), scale = hn::Div(one, hn::IfThenElse(hn::Gt(sum, hn::Zero(d)), sum, one));
        for (int k = 0; k < slots; ++k) {
            hn::Store(cache[k], Whole(), reinterpret_cast<std::int32_t*>(near.cache[k] + at));
            hn::Store(hn::Mul(weight[k], scale), d, near.weight[k] + at);
        }
    }
};

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
    // From the corner (-1, -1) on: look-ups reach half a texel beyond the map.
    const Index one = hn::Set(di, 1), square = hn::Add(hn::Mul(hn::Add(y0, one), hn::Add(size, one)), hn::Add(x0, one));
    Index texel[4] = {hn::Set(di, -1), hn::Set(di, -1), hn::Set(di, -1), hn::Set(di, -1)};
    for_each_distinct(hn::RebindMask(di, mapped), square, [&](auto same, std::int32_t number) HWY_ATTR {
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

    HWY_INLINE Between(Vector position, float lower, float upper, int cells) {
        const Tag d;
        const Whole di;
        const Vector size = hn::Set(d, std::max(upper - lower, 1e-30f)), count = hn::Set(d, static_cast<float>(cells));
        const Vector at = hn::MulSub(hn::Div(hn::Sub(position, hn::Set(d, lower)), size), count, hn::Set(d, 0.5f));
        const Vector inside = hn::Min(hn::Max(at, hn::Zero(d)), hn::Set(d, static_cast<float>(cells - 1)));
        low = hn::Min(hn::ConvertTo(di, inside), hn::Set(di, std::max(cells - 2, 0)));
        share = hn::Sub(inside, hn::ConvertTo(d, low));
    }
};

/// Trilinear between the cells about a position where `hit` holds; where all of them are missing, the nearest cell's stand-in.
HWY_INLINE Slots in_grid(const GridSites& grid, LaneMask hit, const Vec3& position) {
    const Tag d;
    const Whole di;
    const vec3 &lower = grid.box.lower, &upper = grid.box.upper;
    const Between x(position.x, lower.x, upper.x, grid.size.x), y(position.y, lower.y, upper.y, grid.size.y),
        z(position.z, lower.z, upper.z, grid.size.z);
    const Index lowest =
        hn::Add(hn::Mul(hn::Add(hn::Mul(z.low, hn::Set(di, grid.size.y)), y.low), hn::Set(di, grid.size.x)), x.low);
    int corners = 0, place[NearCaches::slots];  // cells from the lowest one on
    Vector weight[NearCaches::slots];
    for (int k = 0; k < NearCaches::slots; ++k) {
        const int i = k & 1, j = (k >> 1) & 1, l = k >> 2;
        if (i >= grid.size.x || j >= grid.size.y || l >= grid.size.z) continue;
        place[corners] = (l * grid.size.y + j) * grid.size.x + i;
        weight[corners++] = hn::Mul(hn::Mul(part(x.share, i), part(y.share, j)), part(z.share, l));
    }
    const auto within = hn::RebindMask(di, hit);
    Index cache[NearCaches::slots];
    for (int k = 0; k < corners; ++k) cache[k] = hn::Set(di, -1);
    for_each_distinct(within, lowest, [&](auto same, std::int32_t first) HWY_ATTR {
        for (int k = 0; k < corners; ++k)
            cache[k] = hn::IfThenElse(
                same, hn::Set(di, static_cast<std::int32_t>(grid.cache[static_cast<std::size_t>(first + place[k])])), cache[k]);
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
        const auto stand_in = static_cast<std::int32_t>(grid.nearest[static_cast<std::size_t>(cell)]);
        cache[0] = hn::IfThenElse(same, hn::Set(di, stand_in), cache[0]);
    });
    add(instead, 0, hn::IfThenElse(alone, cache[0], hn::Set(di, -1)), hn::Set(d, 1.0f));
    slots.cache[0] = hn::IfThenElse(alone, instead.cache[0], slots.cache[0]);
    slots.weight[0] = hn::IfThenElse(none, instead.weight[0], slots.weight[0]);
    slots.sum = hn::IfThenElse(none, instead.sum, slots.sum);
    return slots;
}

/// Where a vector of pixels lies in the light map: u, v, how much its normal agrees with the front's, and 2 where there is a
/// chart, 1 where there is none, 0 where nothing was hit.
void look_up_charts(const CacheSites& sites, const GBuffer& g, std::size_t first, std::size_t count, float* places) {
    const hn::FixedTag<float, 4> d4;
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t triangle = g.triangle[first + k];
        float* const place = places + 4 * k;
        place[3] = triangle == no_hit ? 0.0f : 1.0f;
        if (triangle == no_hit || g.instance[first + k] != 0 || sites.map.size == 0) continue;
        const std::uint32_t plane = sites.map.plane_of[triangle];
        if (plane == no_chart) continue;
        const float* const column = &sites.map.planes[plane].column[0].x;
        const vec3 &p = g.position[first + k], &n = g.geometric_normal[first + k];
        auto sum = hn::Load(d4, column + 12);
        for (int axis = 0; axis < 3; ++axis) {
            const auto by = hn::ConcatUpperLower(d4, hn::Set(d4, n[axis]), hn::Set(d4, p[axis]));
            sum = hn::MulAdd(hn::Load(d4, column + 4 * axis), by, sum);
        }
        hn::Store(sum, d4, place);
        place[3] = 2.0f;
    }
}

void FindCaches(const CacheSites& sites, const GBuffer& g, std::size_t first, std::size_t count, NearCaches& near) {
    const Tag d;
    const Whole di;
    for (std::size_t at = 0; at < count; at += lanes) {
        const std::size_t here = std::min(lanes, count - at);
        alignas(64) float places[4 * lanes] = {};
        look_up_charts(sites, g, first + at, here, places);
        Vector u, v, facing, state;
        hn::LoadInterleaved4(d, places, u, v, facing, state);
        // The map's caches see what the front sees.
        const auto mapped = hn::And(hn::Eq(state, hn::Set(d, 2.0f)), hn::Ge(facing, hn::Zero(d)));
        Slots map;
        if (!hn::AllFalse(d, mapped)) map = in_map(sites.map, mapped, u, v);
        const auto other = hn::And(hn::Gt(state, hn::Zero(d)), hn::Eq(map.sum, hn::Zero(d)));
        if (hn::AllFalse(d, other) || sites.grid.size.x == 0) {
            map.store(NearCaches::slots, at, near);
            continue;
        }
        alignas(64) float places3[3 * lanes] = {};
        std::copy_n(&g.position[first + at].x, 3 * here, places3);
        Vec3 position;
        hn::LoadInterleaved3(d, places3, position.x, position.y, position.z);
        const vec3& lower = sites.grid.box.lower;  // undefined where nothing was hit
        position = choose(other, position, {hn::Set(d, lower.x), hn::Set(d, lower.y), hn::Set(d, lower.z)});
        Slots both = in_grid(sites.grid, other, position);
        for (int k = 0; k < NearCaches::slots; ++k) {
            both.cache[k] = hn::IfThenElse(hn::RebindMask(di, other), both.cache[k], map.cache[k]);
            both.weight[k] = hn::IfThenElse(other, both.weight[k], map.weight[k]);
        }
        both.sum = hn::IfThenElse(other, both.sum, map.sum);
        both.store(NearCaches::slots, at, near);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(FindCaches);

CacheFinder::CacheFinder(const CacheSites& sites, const GBuffer& gbuffer) : sites_(sites), gbuffer_(gbuffer) {
    if (sites.pixels) {
        of_pixel_ = Buffer<std::uint32_t>(gbuffer.pixels(), no_cache);
        std::uint32_t next = 0;
        for (std::size_t pixel = 0; pixel < gbuffer.pixels(); ++pixel)
            if (gbuffer.hit(pixel)) of_pixel_[pixel] = next++;
        if (next != sites.size()) throw std::invalid_argument("evaluate: these caches are of another picture's pixels");
    }
}

void CacheFinder::find(std::size_t first, int count, NearCaches& near) const {
    if (!sites_.pixels) {
        HWY_DYNAMIC_DISPATCH(FindCaches)(sites_, gbuffer_, first, static_cast<std::size_t>(count), near);
        return;
    }
    for (int slot = 0; slot < NearCaches::slots; ++slot) std::fill_n(near.weight[slot], NearCaches::length, 0.0f);
    for (int k = 0; k < count; ++k) {
        const std::uint32_t own = of_pixel_[first + static_cast<std::size_t>(k)];
        near.cache[0][k] = own == no_cache ? 0 : own, near.weight[0][k] = own == no_cache ? 0.0f : 1.0f;
    }
}

}  // namespace interreflect
#endif
