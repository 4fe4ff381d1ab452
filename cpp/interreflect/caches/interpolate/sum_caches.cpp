#include "caches/interpolate/sum_caches.h"

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
// Some 100 cycles, all of it arithmetic and permutations within the first cache; levels of more than 64 texels are gathered, in
// 150.
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

HWY_INLINE void reach(const CacheWeights::Terms& cache, const PixelViews& views, CacheSums& sums, Reached& reached) {
    const Tag d;
    const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Vec3 position = everywhere(cache.position), normal = everywhere(cache.normal);
    const Vector column = hn::Set(d, cache.screen.x), row = hn::Set(d, cache.screen.y), start = hn::Set(d, cache.start);
    const Vector world = hn::Set(d, cache.world_inverse), screen = hn::Set(d, cache.screen_inverse),
                 slope = hn::Set(d, cache.slope);
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int i = 0; i < views.count; i += lanes) {
        const Vec3 at = load(views.position, i),
                   away{hn::Sub(at.x, position.x), hn::Sub(at.y, position.y), hn::Sub(at.z, position.z)};
        const Vector x = hn::Sub(hn::Load(d, views.screen[0] + i), column), y = hn::Sub(hn::Load(d, views.screen[1] + i), row);
        const Vector near =
            hn::Min(hn::NegMulAdd(dot(away, away), world, one), hn::NegMulAdd(hn::MulAdd(x, x, hn::Mul(y, y)), screen, one));
        const Vector agreement = hn::MulAdd(dot(load(views.normal, i), normal), slope, start);
        const Vector weight = hn::Mul(near, hn::Min(agreement, one));
        const auto within = hn::And(hn::Gt(near, zero), hn::Gt(agreement, zero));
        if (hn::AllFalse(d, within)) continue;
        const Vector kept = hn::IfThenElseZero(within, weight);
        hn::Store(kept, d, reached.weight + i);
        hn::Store(hn::Add(hn::Load(d, sums.weight + i), kept), d, sums.weight + i);
        reached.pixels += hn::CountTrue(d, within);
        reached.first[reached.vectors++] = static_cast<std::uint16_t>(i);
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
