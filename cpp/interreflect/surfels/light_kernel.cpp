#include "surfels/light_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "math/spherical_harmonics.h"
#include "surfels/light_caches.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfels/light_kernel.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/half_lanes-inl.h"
#include "math/lanes-inl.h"
#include "surfels/cone_lanes-inl.h"

// Roofline: every link is read once, 4 + 2 bands^2 bytes, or 12 of a cone. At four bands three multiply-adds of sixteen lanes go
// with the 36 bytes of a link; a cone's take four more, and about five for where it points.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Writes a cache as half floats.
void StoreCache(LightCaches& caches, std::size_t cache, const float* red, const float* green, const float* blue) {
    const Tag d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
    const int luma = caches.luma(), chrominance = caches.chrominance();
    alignas(64) float values[3][64];
    Vector largest = hn::Set(d, 0x1p-120f);
    const auto n = [&](float value) HWY_ATTR { return hn::Set(d, value); };
    for (int k = 0; k < luma; k += lanes) {
        const Vector r = hn::Load(d, red + k), g = hn::Load(d, green + k), b = hn::Load(d, blue + k);
        const Vector both = hn::Add(r, b);
        const Vector channel[3] = {
            caches.ycocg ? hn::MulAdd(n(0.5f), g, hn::Mul(n(0.25f), both)) : r,
            caches.ycocg ? hn::Mul(n(0.5f), hn::Sub(r, b)) : g,
            caches.ycocg ? hn::MulSub(n(0.5f), g, hn::Mul(n(0.25f), both)) : b,
        };
        const auto counts = hn::Lt(hn::Iota(d, static_cast<float>(k)), n(static_cast<float>(luma)));
        for (int c = 0; c < 3; ++c) {
            hn::Store(channel[c], d, values[c] + k);
            largest = hn::Max(largest, hn::IfThenElseZero(counts, hn::Abs(channel[c])));
        }
    }
    // The power of two below the largest: dividing by it is exact.
    const float unit = std::ldexp(1.0f, std::ilogb(hn::GetLane(hn::MaxOfLanes(d, largest))));
    caches.unit[cache] = unit;
    const Vector inverse = n(1.0f / unit);
    auto* to = reinterpret_cast<hwy::float16_t*>(caches.coefficients.data()) + cache * static_cast<std::size_t>(caches.stride());
    for (int c = 0; c < 3; ++c) {
        const int count = c == 0 ? luma : chrominance;
        alignas(64) hwy::float16_t halves[64];
        for (int k = 0; k < count; k += lanes)
            hn::Store(nearest_halves(d, hn::Mul(hn::Load(d, values[c] + k), inverse)), hn::Rebind<hwy::float16_t, Tag>(),
                      halves + k);
        std::memcpy(to, halves, static_cast<std::size_t>(count) * sizeof(hwy::float16_t));
        to += count;
    }
}

/// Sums of a colour each, `count` vectors of coefficients, in registers: arrays whose index is found at run time g++ leaves in
/// memory, so that a store and a load lie between two additions.
template <int count>
struct LinkSums {
    Vector red[count], green[count], blue[count];

    HWY_INLINE LinkSums() {
        for (int v = 0; v < count; ++v) red[v] = green[v] = blue[v] = hn::Zero(Tag());
    }
    /// The coefficients of one link, half floats, times its node's light.
    HWY_INLINE void add(const hwy::float16_t* coefficients, const vec3& sent) {
        const Tag d;
        const hn::Rebind<hwy::float16_t, Tag> half;
        const Vector r = hn::Set(d, sent.x), g = hn::Set(d, sent.y), b = hn::Set(d, sent.z);
        for (int v = 0; v < count; ++v) {
            const Vector c = hn::PromoteTo(d, hn::LoadU(half, coefficients + static_cast<std::size_t>(v) * hn::MaxLanes(d)));
            red[v] = hn::MulAdd(c, r, red[v]), green[v] = hn::MulAdd(c, g, green[v]), blue[v] = hn::MulAdd(c, b, blue[v]);
        }
    }
    HWY_INLINE void add(const LinkSums& other) {
        for (int v = 0; v < count; ++v) {
            red[v] = hn::Add(red[v], other.red[v]), green[v] = hn::Add(green[v], other.green[v]);
            blue[v] = hn::Add(blue[v], other.blue[v]);
        }
    }
    HWY_INLINE void store(float unit, float* colours) const {
        const Tag d;
        const Vector by = hn::Set(d, unit);
        for (int v = 0; v < count; ++v) {
            float* const to = colours + static_cast<std::size_t>(v) * hn::MaxLanes(d);
            hn::Store(hn::Mul(red[v], by), d, to), hn::Store(hn::Mul(green[v], by), d, to + 64);
            hn::Store(hn::Mul(blue[v], by), d, to + 128);
        }
    }
};

/// Even and odd links apart where that is few vectors, as an addition waits for the one before.
template <int count, bool packed>
void sum_links(const CacheLinks& links, const NodeLight& light, std::size_t cache, float* colours) {
    const auto each = coefficients_of(links.bands), all = static_cast<std::size_t>(links.per_cache);
    const auto* coefficients = reinterpret_cast<const hwy::float16_t*>(links.coefficients.data()) + cache * all * each;
    const std::uint32_t* const node = links.node.data() + cache * all;
    const vec3* const value = light.value.data();
    const auto sent = [&](std::size_t k) { return packed ? light.at(node[k]) : value[node[k]]; };
    LinkSums<count> even, odd;
    constexpr bool apart = count <= 2;  // more sums than that find no room in sixteen registers
    std::size_t k = 0;
    for (; k + 2 <= all; k += 2) {
        even.add(coefficients + k * each, sent(k));
        (apart ? odd : even).add(coefficients + (k + 1) * each, sent(k + 1));
    }
    if (k < all) even.add(coefficients + k * each, sent(k));
    even.add(odd);
    even.store(links.unit, colours);
}

template <int count>
void sum_links(const CacheLinks& links, const NodeLight& light, std::size_t cache, float* colours) {
    (light.is_packed() ? sum_links<count, true> : sum_links<count, false>)(links, light, cache, colours);
}

void ProjectedCaches(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches) {
    const Tag d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
    alignas(64) float colours[3 * 64];
    const int count = (caches.luma() + lanes - 1) / lanes;
    for (std::size_t cache = begin; cache < end; ++cache) {
        if (count == 1)
            sum_links<1>(links, light, cache, colours);
        else if (count == 2)
            sum_links<2>(links, light, cache, colours);
        else if (count <= 4)
            sum_links<4>(links, light, cache, colours);
        else if (count <= 8)
            sum_links < 64 / lanes<8 ? 64 / lanes : 8>(links, light, cache, colours);
        else
            sum_links<64 / lanes>(links, light, cache, colours);
        StoreCache(caches, cache, colours, colours + 64, colours + 128);
    }
}

/// Sixteen links at a time, where vectors are that wide.
template <int bands>
void sum_cones(const CacheLinks& links, const NodeLight& light, std::size_t cache, float* colours) {
    const Tag d;
    constexpr std::size_t lanes = hn::MaxLanes(d), per_colour = bands * bands;
    Vector sum[3][per_colour];
    for (auto& colour : sum)
        for (Vector& one : colour) one = hn::Zero(d);
    const std::size_t first = cache * static_cast<std::size_t>(links.per_cache),
                      end = first + static_cast<std::size_t>(links.per_cache);
    // Places without a link come last, and no cone is as narrow as theirs.
    for (std::size_t at = first; at < end && links.cones[at].one_less_cos != 0; at += lanes)
        add_cones<bands>(load_cones<bands>(links, light, at, std::min(lanes, end - at)), sum);
    const auto& norms = detail::harmonic_norms();
    for (int l = 0; l < bands; ++l)
        for (int m = -l; m <= l; ++m) {
            const float scale = norms[static_cast<std::size_t>(l)][static_cast<std::size_t>(m < 0 ? -m : m)] * links.unit;
            const int i = l * l + l + m;
            for (int colour = 0; colour < 3; ++colour)
                colours[64 * colour + i] = hn::GetLane(hn::SumOfLanes(d, sum[colour][i])) * scale;
        }
}

void ConeCaches(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches) {
    alignas(64) float colours[3 * 64];
    for (std::size_t cache = begin; cache < end; ++cache) {
        [&]<int... less>(std::integer_sequence<int, less...>) {
            ((caches.bands == less + 1 ? sum_cones<less + 1>(links, light, cache, colours) : void()), ...);
        }
        (std::make_integer_sequence<int, most_bands>());
        StoreCache(caches, cache, colours, colours + 64, colours + 128);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(StoreCache);
HWY_EXPORT(ProjectedCaches);
HWY_EXPORT(ConeCaches);

void store_cache(LightCaches& caches, std::size_t cache, const float* red, const float* green, const float* blue) {
    HWY_DYNAMIC_DISPATCH(StoreCache)(caches, cache, red, green, blue);
}

void light_projected(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches) {
    HWY_DYNAMIC_DISPATCH(ProjectedCaches)(links, light, begin, end, caches);
}

void light_cones(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches) {
    HWY_DYNAMIC_DISPATCH(ConeCaches)(links, light, begin, end, caches);
}
}  // namespace interreflect
#endif
