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
// four multiply-adds of four lanes, which texels or cells lie about it some 40 or 100 operations of one lane, and 4 or 8 gathers.
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

/// What is listed at `index` where `at` holds; no_cache elsewhere.
template <class M>
HWY_INLINE Index listed(const Buffer<std::uint32_t>& list, M at, Index index) {
    const Whole di;
    const Index found = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(list.data()), hn::IfThenElseZero(at, index));
    return hn::IfThenElse(at, found, hn::Set(di, -1));
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
    const auto within = [&](Index i) HWY_ATTR { return hn::And(hn::Gt(i, hn::Set(di, -1)), hn::Lt(i, size)); };
    Slots slots;
    for (int k = 0; k < 4; ++k) {
        const Index x = hn::Add(x0, hn::Set(di, k & 1)), y = hn::Add(y0, hn::Set(di, k >> 1));
        const auto there = hn::And(hn::And(within(x), within(y)), hn::RebindMask(di, mapped));
        add(slots, k, listed(map.cache, there, hn::Add(hn::Mul(y, size), x)), hn::Mul(part(across, k & 1), part(down, k >> 1)));
    }
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
    Slots slots;
    Vector most = hn::Set(d, -1.0f);
    Index nearest = hn::Zero(di);
    for (int k = 0; k < 8; ++k) {
        const int i = k & 1, j = (k >> 1) & 1, l = k >> 2;
        if (i >= grid.size.x || j >= grid.size.y || l >= grid.size.z) continue;
        const Index across = hn::Add(x.low, hn::Set(di, i)), up = hn::Add(y.low, hn::Set(di, j)),
                    along = hn::Add(z.low, hn::Set(di, l));
        const Index cell =
            hn::Add(hn::Mul(hn::Add(hn::Mul(along, hn::Set(di, grid.size.y)), up), hn::Set(di, grid.size.x)), across);
        const Vector weight = hn::Mul(hn::Mul(part(x.share, i), part(y.share, j)), part(z.share, l));
        const auto more = hn::Gt(weight, most);
        most = hn::Max(most, weight), nearest = hn::IfThenElse(hn::RebindMask(di, more), cell, nearest);
        add(slots, k, listed(grid.cache, hn::RebindMask(di, hit), cell), weight);
    }
    const auto none = hn::And(hn::Eq(slots.sum, hn::Zero(d)), hit);
    if (!hn::AllFalse(d, none)) {
        Slots instead;
        add(instead, 0, listed(grid.nearest, hn::RebindMask(di, none), nearest), hn::Set(d, 1.0f));
        slots.cache[0] = hn::IfThenElse(hn::RebindMask(di, none), instead.cache[0], slots.cache[0]);
        slots.weight[0] = hn::IfThenElse(none, instead.weight[0], slots.weight[0]);
        slots.sum = hn::IfThenElse(none, instead.sum, slots.sum);
    }
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
