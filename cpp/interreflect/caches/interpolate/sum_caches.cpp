#include "caches/interpolate/sum_caches.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "caches/interpolate/cache_reader.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/interpolate/sum_caches.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "caches/interpolate/map_lanes-inl.h"

// Roofline, for a vector of sixteen pixels that one cache reaches: the weight 25 operations; where its maps are looked at 60,
// kept while the caches share their normal; for each of three maps (the table, two levels) 30 for the corners' weights and then
// 40 where all pixels look between the same four texels, as three quarters do, 220 where they do not. Some 150 cycles, all of it
// arithmetic within the first cache.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
          normal(everywhere(cache.frame.normal)),
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

/// Caches that reach a vector of pixels: their weights, and where the pixels' lobes look in maps that stand upright on them.
struct Reached {
    static constexpr int capacity = Looks::capacity, most = hn::MaxLanes(Tag());
    int count = 0;
    std::uint32_t cache[capacity];
    alignas(64) float weight[capacity][most], diffuse[capacity][2][most], glossy[capacity][2][most];
};

HWY_INLINE void store(const Square& square, float (*to)[Reached::most]) {
    hn::Store(square.x, Tag(), to[0]), hn::Store(square.y, Tag(), to[1]);
}
HWY_INLINE Square load_square(const float (*from)[Reached::most]) { return {hn::Load(Tag(), from[0]), hn::Load(Tag(), from[1])}; }

/// A vector of pixels, and what caches have added for them.
class PixelLanes {
  public:
    HWY_INLINE PixelLanes(const PixelViews& views, int first)
        : position_(load(views.position, first)),
          normal_(load(views.normal, first)),
          direction_(load(views.direction, first)),
          column_(hn::Load(Tag(), views.screen[0] + first)),
          row_(hn::Load(Tag(), views.screen[1] + first)),
          weight_(hn::Zero(Tag())) {}

    /// Notes a cache that reaches some of the pixels; returns how many.
    HWY_INLINE std::size_t reach(std::uint32_t number, const CacheWeights::Terms& terms, bool glossy, Reached& reached) {
        const Tag d;
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const WeightLanes cache(terms);
        const Vec3 away{hn::Sub(position_.x, cache.position.x), hn::Sub(position_.y, cache.position.y),
                        hn::Sub(position_.z, cache.position.z)};
        const Vector near = cache.near(away, hn::Sub(column_, cache.column), hn::Sub(row_, cache.row));
        const Vector agreement = cache.agreement(normal_);
        const auto within = hn::And(hn::Gt(near, zero), hn::Gt(agreement, zero));
        if (hn::AllFalse(d, within)) return 0;
        const Vector weight = hn::IfThenElseZero(within, hn::Mul(near, hn::Min(agreement, one)));
        weight_ = hn::Add(weight_, weight);
        find_places(terms.frame, glossy);
        const int i = reached.count++;
        reached.cache[i] = number;
        hn::Store(weight, d, reached.weight[i]);
        store(diffuse_, reached.diffuse[i]);
        if (glossy) store(glossy_, reached.glossy[i]);
        return hn::CountTrue(d, within);
    }
    HWY_INLINE Vector weight() const { return weight_; }

  private:
    HWY_INLINE void find_places(const Frame& frame, bool glossy) {
        // Bit by bit: the frame about a normal depends on the sign of its zeros.
        using Bits = std::array<std::uint32_t, 3>;
        if (std::bit_cast<Bits>(places_about_) == std::bit_cast<Bits>(frame.normal)) return;
        places_about_ = frame.normal;
        const Vec3 x = everywhere(frame.tangent), y = everywhere(frame.bitangent), z = everywhere(frame.normal);
        diffuse_ = hemisphere_square_lanes({dot(normal_, x), dot(normal_, y), dot(normal_, z)});
        if (glossy) glossy_ = hemisphere_square_lanes({dot(direction_, x), dot(direction_, y), dot(direction_, z)});
    }

    Vec3 position_, normal_, direction_;
    Vector column_, row_;
    vec3 places_about_{0};
    Square diffuse_, glossy_;
    Vector weight_;
};

/// Adds one layer of the caches that reach the vector of pixels at `first`.
void add_layer(const ConvolvedCaches& caches, const Buffer<std::uint16_t>& filled, const ConvolvedCaches::Layer& layer,
               const Reached& reached, const PixelViews& views, int first, float (*diffuse)[CacheSums::capacity],
               float (*glossy)[CacheSums::capacity]) {
    const Tag d;
    const auto add = [&](Looks& looks, float(*to)[CacheSums::capacity]) HWY_ATTR {
        Vector sum[4];
        for (int c = 0; c < 4; ++c) sum[c] = hn::Load(d, to[c] + first);
        looks.add_to(sum);
        for (int c = 0; c < 4; ++c) hn::Store(sum[c], d, to[c] + first);
    };
    Looks table(caches.table_size);
    for (int k = 0; k < reached.count; ++k)
        table.look(LayerMaps(caches, filled, layer, reached.cache[k]).table, load_square(reached.diffuse[k]),
                   hn::Load(d, reached.weight[k]));
    add(table, diffuse);
    for (int level = views.finest; level <= views.coarsest; ++level) {
        const Vector off = hn::AbsDiff(hn::Load(d, views.level + first), hn::Set(d, static_cast<float>(level)));
        const Vector share = hn::Max(hn::Sub(hn::Set(d, 1.0f), off), hn::Zero(d));
        if (hn::AllFalse(d, hn::Gt(share, hn::Zero(d)))) continue;
        Looks looks(caches.level_sizes[static_cast<std::size_t>(level)]);
        for (int k = 0; k < reached.count; ++k)
            looks.look(LayerMaps(caches, filled, layer, reached.cache[k]).level(level), load_square(reached.glossy[k]),
                       hn::Mul(hn::Load(d, reached.weight[k]), share));
        add(looks, glossy);
    }
}

/// The sums of the vector of pixels at `first`; returns how many of them the caches reach.
std::uint64_t add_to_lanes(const ConvolvedCaches& caches, const CacheWeights& weights, std::span<const std::uint32_t> near,
                           const PixelViews& views, int first, CacheSums& sums) {
    const Tag d;
    const bool image = !caches.filled->sky.empty();
    for (auto* sum : {sums.diffuse, sums.glossy, sums.diffuse_sky, sums.glossy_sky})
        for (int c = 0; c < 4; ++c) hn::Store(hn::Zero(d), d, sum[c] + first);
    PixelLanes lanes(views, first);
    std::uint64_t pixels = 0;
    Reached reached;
    const auto add = [&]() HWY_ATTR {
        add_layer(caches, caches.filled->texels, caches.light, reached, views, first, sums.diffuse, sums.glossy);
        if (image) add_layer(caches, caches.filled->sky, caches.sky, reached, views, first, sums.diffuse_sky, sums.glossy_sky);
        reached.count = 0;
    };
    for (const std::uint32_t cache : near) {
        pixels += lanes.reach(cache, weights.of(cache), views.coarsest >= 0, reached);
        if (reached.count == Reached::capacity) add();
    }
    if (reached.count > 0) add();
    hn::Store(lanes.weight(), d, sums.weight + first);
    return pixels;
}

std::uint64_t add_caches(const ConvolvedCaches& caches, const CacheWeights& weights, std::span<const std::uint32_t> near,
                         const PixelViews& views, CacheSums& sums) {
    thread_local std::vector<std::uint32_t> groups, reaching;
    groups.resize(near.size()), reaching.resize(near.size());
    for (std::size_t k = 0; k < near.size(); ++k) groups[k] = groups_within(WeightLanes(weights.of(near[k])), views);
    std::uint64_t pixels = 0;
    for (int g = 0; g * PixelViews::group < views.count; ++g) {
        std::size_t count = 0;
        for (std::size_t k = 0; k < near.size(); ++k) reaching[count] = near[k], count += groups[k] >> g & 1;
        const int end = std::min((g + 1) * PixelViews::group, views.count);
        for (int i = g * PixelViews::group; i < end; i += static_cast<int>(hn::Lanes(Tag())))
            pixels += add_to_lanes(caches, weights, std::span(reaching).first(count), views, i, sums);
    }
    return pixels;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
namespace {

HWY_EXPORT(add_caches);

/// Lobes that are sampled are read one by one.
std::uint64_t add_samples(const CacheReader& reader, const CacheWeights& weights, std::span<const std::uint32_t> near,
                          const PixelViews& views, CacheSums& sums) {
    std::uint64_t pixels = 0;
    for (int i = 0; i < views.count; ++i) {
        const PixelViews::View view = views.view(i);
        CacheSum sum;
        for (const std::uint32_t cache : near) {
            const float weight = weights.weight(cache, view);
            if (!(weight > 0.0f)) continue;
            sum.add(reader.read(cache, view), weight);
            ++pixels;
        }
        sums.set(i, sum);
    }
    return pixels;
}

}  // namespace

std::uint64_t CacheSummer::sum(std::span<const std::uint32_t> near, const PixelViews& views, CacheSums& sums) const {
    if (caches_.samples > 0) return add_samples(CacheReader(caches_, gbuffer_, scene_), weights_, near, views, sums);
    return HWY_DYNAMIC_DISPATCH(add_caches)(caches_, weights_, near, views, sums);
}

}  // namespace interreflect
#endif
