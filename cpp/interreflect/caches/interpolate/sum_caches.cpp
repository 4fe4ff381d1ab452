#include "caches/interpolate/sum_caches.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "caches/interpolate/cache_reader.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/interpolate/sum_caches.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "caches/interpolate/map_lanes-inl.h"

// Roofline, for a vector of sixteen pixels that one cache reaches: the weight 20 operations; where its maps are looked at 60,
// kept while the caches share their normal; a table of up to 64 texels in registers 60, each of two levels of up to 32 texels 45.
// Some 100 cycles, all of it arithmetic and permutations within the first cache; of levels with more than 64 texels each lane
// loads its own.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The vectors that a cache reaches, and the weights in them.
struct Reached {
    alignas(64) float weight[PixelViews::capacity];
    std::uint16_t first[PixelViews::capacity];  // lane of each vector
    int vectors = 0;
    std::uint64_t pixels = 0;
};

HWY_INLINE Vec3 load(const float (*from)[PixelViews::capacity], int i) {
    const Tag d;
    return {hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
}
HWY_INLINE Vec3 everywhere(const vec3& v) {
    const Tag d;
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}

/// A cache's weights, for one pixel a lane.
struct WeightLanes {
    Vec3 position, normal;
    Vector column, row, world, screen, slope, start;

    explicit HWY_INLINE WeightLanes(const CacheWeights::Terms& cache)
        : position(everywhere(cache.position)),
          normal(everywhere(cache.normal)),
          column(hn::Set(Tag(), cache.screen.x)),
          row(hn::Set(Tag(), cache.screen.y)),
          world(hn::Set(Tag(), cache.world_inverse)),
          screen(hn::Set(Tag(), cache.screen_inverse)),
          slope(hn::Set(Tag(), cache.slope)),
          start(hn::Set(Tag(), cache.start)) {}
    HWY_INLINE Vector near(const Vec3& away, Vector x, Vector y) const {
        const Vector one = hn::Set(Tag(), 1.0f);
        return hn::Min(hn::NegMulAdd(dot(away, away), world, one), hn::NegMulAdd(hn::MulAdd(x, x, hn::Mul(y, y)), screen, one));
    }
    HWY_INLINE Vector agreement(const Vec3& of) const { return hn::MulAdd(dot(of, normal), slope, start); }
};

/// A bit for each group of pixels that the cache may reach: the best that a pixel within the group's bounds could have. Rounding
/// is monotonic, and the operations are those of the weights: no pixel of a positive weight is lost.
HWY_INLINE std::uint32_t groups_within(const WeightLanes& cache, const PixelViews& views) {
    const Tag d;
    const Vector zero = hn::Zero(d);
    const int lanes = static_cast<int>(hn::Lanes(d));
    std::uint32_t groups = 0;
    for (int g = 0; g < PixelViews::groups; g += lanes) {
        const auto outside = [&](const PixelViews::Bounds& bounds, Vector at) HWY_ATTR {
            const Vector below = hn::Sub(hn::Load(d, bounds.lower + g), at), above = hn::Sub(at, hn::Load(d, bounds.upper + g));
            return hn::Max(hn::Max(below, above), zero);
        };
        const auto furthest = [&](const PixelViews::Bounds& bounds, Vector along) HWY_ATTR {
            return hn::IfThenElse(hn::Gt(along, zero), hn::Load(d, bounds.upper + g), hn::Load(d, bounds.lower + g));
        };
        const Vec3 away{outside(views.position_bounds[0], cache.position.x), outside(views.position_bounds[1], cache.position.y),
                        outside(views.position_bounds[2], cache.position.z)};
        const Vector near =
            cache.near(away, outside(views.screen_bounds[0], cache.column), outside(views.screen_bounds[1], cache.row));
        const Vector agreement =
            cache.agreement({furthest(views.normal_bounds[0], cache.normal.x), furthest(views.normal_bounds[1], cache.normal.y),
                             furthest(views.normal_bounds[2], cache.normal.z)});
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::And(hn::Gt(near, zero), hn::Gt(agreement, zero)), bits);
        groups |= (bits[0] | static_cast<std::uint32_t>(bits[1]) << 8) << g;
    }
    return groups;
}

HWY_INLINE void reach(const CacheWeights::Terms& terms, const PixelViews& views, CacheSums& sums, Reached& reached) {
    const Tag d;
    const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const WeightLanes cache(terms);
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto add = [&](int i) HWY_ATTR {
        const Vec3 at = load(views.position, i),
                   away{hn::Sub(at.x, cache.position.x), hn::Sub(at.y, cache.position.y), hn::Sub(at.z, cache.position.z)};
        const Vector near = cache.near(away, hn::Sub(hn::Load(d, views.screen[0] + i), cache.column),
                                       hn::Sub(hn::Load(d, views.screen[1] + i), cache.row));
        const Vector agreement = cache.agreement(load(views.normal, i));
        const Vector weight = hn::Mul(near, hn::Min(agreement, one));
        const auto within = hn::And(hn::Gt(near, zero), hn::Gt(agreement, zero));
        if (hn::AllFalse(d, within)) return;
        const Vector kept = hn::IfThenElseZero(within, weight);
        hn::Store(kept, d, reached.weight + i);
        hn::Store(hn::Add(hn::Load(d, sums.weight + i), kept), d, sums.weight + i);
        reached.pixels += hn::CountTrue(d, within);
        reached.first[reached.vectors++] = static_cast<std::uint16_t>(i);
    };
    for (std::uint32_t groups = groups_within(cache, views); groups != 0; groups &= groups - 1) {
        const int first = std::countr_zero(groups) * PixelViews::group;
        for (int i = first; i < std::min(first + PixelViews::group, views.count); i += lanes) add(i);
    }
}

HWY_INLINE void find_places(const vec3& normal, bool glossy, const PixelViews& views, const Reached& reached,
                            CacheSums::Places& places) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    // Bit by bit: the frame about a normal depends on the sign of its zeros.
    if (std::memcmp(&places.normal, &normal, sizeof(vec3)) != 0) places.known = 0, places.normal = normal;
    const Frame frame(normal);
    const Vec3 x = everywhere(frame.tangent), y = everywhere(frame.bitangent), z = everywhere(normal);
    const auto place = [&](const Vec3& direction, float(*to)[CacheSums::capacity], int i) HWY_ATTR {
        const Square square = hemisphere_square_lanes({dot(direction, x), dot(direction, y), dot(direction, z)});
        hn::Store(square.x, d, to[0] + i);
        hn::Store(square.y, d, to[1] + i);
    };
    for (int k = 0; k < reached.vectors; ++k) {
        const int i = reached.first[k];
        const std::uint64_t bit = std::uint64_t{1} << (i / lanes);
        if ((places.known & bit) != 0) continue;
        places.known |= bit;
        place(load(views.normal, i), places.diffuse, i);
        if (glossy) place(load(views.direction, i), places.glossy, i);
    }
}

/// Adds an n x n map's texels at the places, times the weights and `share(i)` of the vector at i.
template <class Share>
HWY_INLINE void add_map(const std::uint16_t* texels, int n, const float (*at)[CacheSums::capacity], const Reached& reached,
                        float (*sums)[CacheSums::capacity], const Share& share) {
    const Tag d;
    with_texels(texels, n, [&](const auto& map) HWY_ATTR {
        for (int k = 0; k < reached.vectors; ++k) {
            const int i = reached.first[k];
            const Vector weight = hn::Mul(hn::Load(d, reached.weight + i), share(i));
            if (hn::AllFalse(d, hn::Gt(weight, hn::Zero(d)))) continue;
            const Corners corners(hn::Load(d, at[0] + i), hn::Load(d, at[1] + i), n, weight);
            Vector sum[4];
            for (int c = 0; c < 4; ++c) sum[c] = hn::Load(d, sums[c] + i);
            map.add(corners, sum);
            for (int c = 0; c < 4; ++c) hn::Store(sum[c], d, sums[c] + i);
        }
    });
}

std::uint64_t add_cache(const ConvolvedCaches& caches, std::size_t cache, const CacheWeights::Terms& terms,
                        const PixelViews& views, CacheSums& sums) {
    const Tag d;
    Reached reached;
    reach(terms, views, sums, reached);
    if (reached.vectors == 0) return 0;
    find_places(terms.normal, views.coarsest >= 0, views, reached, sums.places);
    const auto add_layer = [&](const Buffer<std::uint16_t>& filled, const ConvolvedCaches::Layer& layer,
                               float(*diffuse)[CacheSums::capacity], float(*glossy)[CacheSums::capacity]) HWY_ATTR {
        const LayerMaps maps(caches, filled, layer, cache);
        add_map(maps.table, caches.table_size, sums.places.diffuse, reached, diffuse,
                [d](int) HWY_ATTR { return hn::Set(d, 1.0f); });
        for (int level = views.finest; level <= views.coarsest; ++level) {
            const Vector number = hn::Set(d, static_cast<float>(level));
            add_map(maps.level(level), caches.level_sizes[static_cast<std::size_t>(level)], sums.places.glossy, reached, glossy,
                    [&](int i) HWY_ATTR {
                        const Vector off = hn::AbsDiff(hn::Load(d, views.level + i), number);
                        return hn::Max(hn::Sub(hn::Set(d, 1.0f), off), hn::Zero(d));
                    });
        }
    };
    add_layer(caches.filled->texels, caches.light, sums.diffuse, sums.glossy);
    if (!caches.filled->sky.empty()) add_layer(caches.filled->sky, caches.sky, sums.diffuse_sky, sums.glossy_sky);
    return reached.pixels;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
namespace {

HWY_EXPORT(add_cache);

/// Lobes that are sampled are read one by one.
std::uint64_t add_samples(const CacheReader& reader, const CacheWeights& weights, std::size_t cache, const PixelViews& views,
                          CacheSums& sums) {
    std::uint64_t pixels = 0;
    for (int i = 0; i < views.count; ++i) {
        const PixelViews::View view = views.view(i);
        const float weight = weights.weight(cache, view);
        if (!(weight > 0.0f)) continue;
        sums.add(i, reader.read(cache, view), weight);
        ++pixels;
    }
    return pixels;
}

}  // namespace

std::uint64_t CacheSummer::add(std::size_t cache, const PixelViews& views, CacheSums& sums) const {
    const CacheWeights::Terms terms = weights_.of(cache);
    if (!terms.reaches) return 0;
    if (caches_.samples > 0) return add_samples(CacheReader(caches_, gbuffer_, scene_), weights_, cache, views, sums);
    return HWY_DYNAMIC_DISPATCH(add_cache)(caches_, cache, terms, views, sums);
}

}  // namespace interreflect
#endif
