#include "surfels/light_kernel.h"

#include <algorithm>
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

/// `count` vectors of coefficients for each colour.
template <int count>
void sum_links(const CacheLinks& links, const NodeLight& light, std::size_t cache, float* colours) {
    const Tag d;
    const hn::Rebind<hwy::float16_t, Tag> half;
    constexpr std::size_t lanes = hn::MaxLanes(d);
    const std::size_t each = static_cast<std::size_t>(links.bands * links.bands);
    const std::size_t first = cache * static_cast<std::size_t>(links.per_cache);
    const auto* coefficients = reinterpret_cast<const hwy::float16_t*>(links.coefficients.data()) + first * each;
    Vector sum[3][count];
    for (auto& colour : sum)
        for (Vector& one : colour) one = hn::Zero(d);
    for (std::size_t k = 0; k < static_cast<std::size_t>(links.per_cache); ++k, coefficients += each) {
        const vec3 sent = light.value[links.node[first + k]];
        const Vector red = hn::Set(d, sent.x), green = hn::Set(d, sent.y), blue = hn::Set(d, sent.z);
        for (int v = 0; v < count; ++v) {
            const Vector c = hn::PromoteTo(d, hn::LoadU(half, coefficients + static_cast<std::size_t>(v) * lanes));
            sum[0][v] = hn::MulAdd(c, red, sum[0][v]);
            sum[1][v] = hn::MulAdd(c, green, sum[1][v]);
            sum[2][v] = hn::MulAdd(c, blue, sum[2][v]);
        }
    }
    const Vector unit = hn::Set(d, links.unit);
    for (int colour = 0; colour < 3; ++colour)
        for (int v = 0; v < count; ++v)
            hn::Store(hn::Mul(sum[colour][v], unit), d, colours + 64 * colour + static_cast<std::size_t>(v) * lanes);
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
        store_cache(caches, cache, colours, colours + 64, colours + 128);
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
    for (std::size_t at = first; at < end; at += lanes)
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
        store_cache(caches, cache, colours, colours + 64, colours + 128);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(ProjectedCaches);
HWY_EXPORT(ConeCaches);

void light_projected(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches) {
    HWY_DYNAMIC_DISPATCH(ProjectedCaches)(links, light, begin, end, caches);
}

void light_cones(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches) {
    HWY_DYNAMIC_DISPATCH(ConeCaches)(links, light, begin, end, caches);
}
}  // namespace interreflect
#endif
