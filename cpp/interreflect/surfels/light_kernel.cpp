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
    const hn::Rebind<hwy::float16_t, Tag> half;
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
            hn::Store(hn::DemoteTo(half, hn::Mul(hn::Load(d, values[c] + k), inverse)), half, halves + k);
        std::memcpy(to, halves, static_cast<std::size_t>(count) * sizeof(hwy::float16_t));
        to += count;
    }
}

/// `count` vectors of coefficients for each colour. Sums of even and odd links, as an addition waits for the one before.
template <int count>
void sum_links(const CacheLinks& links, const NodeLight& light, std::size_t cache, float* colours) {
    const Tag d;
    const hn::Rebind<hwy::float16_t, Tag> half;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    constexpr int apart = count <= 2 ? 2 : 1;
    const std::size_t each = static_cast<std::size_t>(links.bands * links.bands);
    const std::size_t first = cache * static_cast<std::size_t>(links.per_cache);
    const auto* coefficients = reinterpret_cast<const hwy::float16_t*>(links.coefficients.data()) + first * each;
    Vector sum[apart][3][count];
    for (auto& one : sum)
        for (auto& colour : one)
            for (Vector& part : colour) part = hn::Zero(d);
    const auto add = [&](std::size_t k, int to) HWY_ATTR {
        const vec3 sent = light.at(links.node[first + k]);
        const Vector red = hn::Set(d, sent.x), green = hn::Set(d, sent.y), blue = hn::Set(d, sent.z);
        for (int v = 0; v < count; ++v) {
            const Vector c = hn::PromoteTo(d, hn::LoadU(half, coefficients + k * each + static_cast<std::size_t>(v) * lanes));
            sum[to][0][v] = hn::MulAdd(c, red, sum[to][0][v]);
            sum[to][1][v] = hn::MulAdd(c, green, sum[to][1][v]);
            sum[to][2][v] = hn::MulAdd(c, blue, sum[to][2][v]);
        }
    };
    const auto all = static_cast<std::size_t>(links.per_cache);
    std::size_t k = 0;
    for (; k + apart <= all; k += apart)
        for (int to = 0; to < apart; ++to) add(k + static_cast<std::size_t>(to), to);
    for (; k < all; ++k) add(k, 0);
    const Vector unit = hn::Set(d, links.unit);
    for (int colour = 0; colour < 3; ++colour)
        for (int v = 0; v < count; ++v) {
            Vector whole = sum[0][colour][v];
            if (apart == 2) whole = hn::Add(whole, sum[apart - 1][colour][v]);
            hn::Store(hn::Mul(whole, unit), d, colours + 64 * colour + static_cast<std::size_t>(v) * lanes);
        }
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
