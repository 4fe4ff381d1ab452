#include "surfels/evaluate/cache_finder.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfels/evaluate/cache_finder.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "surfels/evaluate/cell_lanes-inl.h"

// Roofline: of each pixel position, geometric normal, triangle and instance, 32 bytes, are read once. A pixel's triangle takes
// four multiply-adds of four lanes, which texels or cells lie about it some 40 or 100 operations of one lane; a vector's few
// distinct cells take 4 or 8 loads each.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

/// The first `count` of a vector.
HWY_INLINE Vec3 load(const vec3* from, std::size_t count) {
    alignas(64) float values[3 * lanes] = {};
    std::copy_n(&from->x, 3 * count, values);
    Vec3 v;
    hn::LoadInterleaved3(Tag(), values, v.x, v.y, v.z);
    return v;
}
HWY_INLINE Vec3 same(const vec3& v) {
    const Tag d;
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

/// From the camera; infinite for surface points that no one camera sees.
HWY_INLINE Vector distance_of(const GBuffer& g, const Vec3& position) {
    const Tag d;
    if (g.seen_head_on) return hn::Set(d, std::numeric_limits<float>::infinity());
    const Vec3 to = moved(position, same(g.camera.position), hn::Set(d, -1.0f));
    return hn::Sqrt(dot(to, to));
}

void FindCaches(const CacheSites& sites, const GBuffer& g, std::size_t first, std::size_t count, NearCaches& near) {
    const Tag d;
    for (std::size_t at = 0; at < count; at += lanes) {
        const std::size_t here = std::min(lanes, count - at);
        alignas(64) float places[4 * lanes] = {};
        look_up_charts(sites, g, first + at, here, places);
        Vector u, v, facing, state;
        hn::LoadInterleaved4(d, places, u, v, facing, state);
        // The map's caches see what the front sees.
        const auto mapped = hn::And(hn::Eq(state, hn::Set(d, 2.0f)), hn::Ge(facing, hn::Zero(d)));
        Slots map, odd;
        if (!hn::AllFalse(d, mapped)) map = in_map(sites.map, mapped, u, v);
        const auto other = hn::And(hn::Gt(state, hn::Zero(d)), hn::Eq(map.sum, hn::Zero(d)));
        if (!hn::AllFalse(d, other) && sites.grid.size.x > 0) {
            const vec3& lower = sites.grid.box.lower;  // undefined where nothing was hit
            const Vec3 position = choose(other, load(&g.position[first + at], here), same(lower));
            const Vec3 normal = choose(other, load(&g.geometric_normal[first + at], here), same(vec3(0)));
            if (sites.grid.levels == 1) {
                map.take(other, in_level(sites.grid, 0, other, position, normal));
            } else {
                const LevelSlots levels(sites.grid, other, position, normal, distance_of(g, position));
                map.take(other, levels.half[0]), odd.take(other, levels.half[1]);
            }
        }
        // So that all weights sum up to 1.
        const Vector whole = inverse(hn::Add(map.sum, odd.sum));
        map.scale(whole);
        map.store(0, at, near);
        if (near.slots == NearCaches::level_slots) continue;
        odd.scale(whole);
        odd.store(NearCaches::level_slots, at, near);
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
    near.slots = sites_.grid.levels > 1 ? NearCaches::most_slots : NearCaches::level_slots;
    if (!sites_.pixels) {
        HWY_DYNAMIC_DISPATCH(FindCaches)(sites_, gbuffer_, first, static_cast<std::size_t>(count), near);
        return;
    }
    for (int slot = 0; slot < near.slots; ++slot) std::fill_n(near.weight[slot], NearCaches::length, 0.0f);
    for (int k = 0; k < count; ++k) {
        const std::uint32_t own = of_pixel_[first + static_cast<std::size_t>(k)];
        near.cache[0][k] = own == no_cache ? 0 : own, near.weight[0][k] = own == no_cache ? 0.0f : 1.0f;
    }
}

}  // namespace interreflect
#endif
