#include "virtual_lights/cluster/texel_runs.h"

#include <algorithm>
#include <cmath>

#include "data/virtual_lights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "virtual_lights/cluster/texel_runs.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline: 44 bytes of a texel to sum it, 28 to pick it. Neighbours are mostly of one cluster: lanes are summed for as long as
// it stays the same.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Unsigned = hn::RebindToUnsigned<Tag>;
constexpr std::size_t widest = 16;

HWY_INLINE Vec3 load_vectors(const vec3* from) {
    Vec3 v;
    hn::LoadInterleaved3(Tag(), reinterpret_cast<const float*>(from), v.x, v.y, v.z);
    return v;
}
HWY_INLINE Vec3 same_vector(const vec3& v) {
    const Tag d;
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
HWY_INLINE Vec3 difference(const Vec3& a, const Vec3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }

/// Texels as the loops read them; fewer than a vector's at the end of a range are copied to here.
struct Texels {
    const vec3 *position, *normal, *flux;
    const float* area;
    const std::uint32_t* cluster;
};
struct Rest {
    vec3 position[widest], normal[widest], flux[widest];
    float area[widest];
    std::uint32_t cluster[widest];

    Texels filled(const Texels& from, std::size_t count) {
        for (std::size_t i = 0; i < widest; ++i) {
            const std::size_t at = std::min(i, count - 1);
            position[i] = from.position[at], normal[i] = from.normal[at], flux[i] = from.flux[at], area[i] = from.area[at];
            cluster[i] = i < count ? from.cluster[at] : no_virtual_light;
        }
        return {position, normal, flux, area, cluster};
    }
};

HWY_INLINE std::uint32_t bits_of(hn::Mask<Unsigned> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Unsigned(), mask, bytes);
    return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
}

/// For every cluster of every vector of texels: body.same(cluster, mask of lanes, texels, number of the first) or, where it is
/// not the last one's and has few lanes, body.one(cluster, texels, lane, number) for each.
template <class Body>
HWY_INLINE void for_clusters(const TexelRange& range, Body& body) {
    constexpr int few = 3;
    const Unsigned du;
    const std::size_t lanes = hn::Lanes(du);
    const ReflectiveShadowMap& map = range.map;
    const std::uint32_t* const all = range.cluster + range.first;
    Rest rest;
    for (std::size_t i = range.begin; i < range.end; i += lanes) {
        Texels texels{map.position.data() + i, map.normal.data() + i, map.flux.data() + i, map.area.data() + i, all + i};
        const std::size_t left = range.end - i;
        if (left < lanes) texels = rest.filled(texels, left);
        const auto clusters = hn::LoadU(du, texels.cluster);
        std::uint32_t open = bits_of(hn::Ne(clusters, hn::Set(du, no_virtual_light)));
        while (open != 0) {
            const std::uint32_t cluster = texels.cluster[__builtin_ctz(open)];
            const auto same = hn::Eq(clusters, hn::Set(du, cluster));
            std::uint32_t mine = bits_of(same);
            open &= ~mine;
            const int count = __builtin_popcount(mine);
            if (count > few || cluster == body.current) {
                body.same(cluster, hn::RebindMask(Tag(), same), static_cast<std::uint32_t>(count), texels, range.first + i);
                continue;
            }
            for (; mine != 0; mine &= mine - 1) {
                const auto lane = static_cast<std::size_t>(__builtin_ctz(mine));
                body.one(cluster, texels, lane, range.first + i + lane);
            }
        }
    }
    body.end();
}

struct Summing {
    const vec3* origins;
    ClusterSum* sums;
    std::uint32_t current = no_virtual_light;
    std::uint32_t members = 0;
    Vec3 position{}, normal{}, flux{}, origin{};
    Vector weight{}, square{}, area{};

    HWY_INLINE void same(std::uint32_t cluster, LaneMask mask, std::uint32_t count, const Texels& texels, std::size_t) {
        if (cluster != current) end(), begin(cluster);
        const Tag d;
        const Vec3 lit = load_vectors(texels.flux), to = difference(load_vectors(texels.position), origin);
        Vector by = hn::Mul(hn::Set(d, 0.2126f), lit.x);
        by = hn::MulAdd(hn::Set(d, 0.7152f), lit.y, by);
        by = hn::IfThenElseZero(mask, hn::MulAdd(hn::Set(d, 0.0722f), lit.z, by));
        position = moved(position, to, by);
        normal = moved(normal, load_vectors(texels.normal), by);
        square = hn::MulAdd(dot(to, to), by, square);
        weight = hn::Add(weight, by);
        flux = {hn::Add(flux.x, hn::IfThenElseZero(mask, lit.x)), hn::Add(flux.y, hn::IfThenElseZero(mask, lit.y)),
                hn::Add(flux.z, hn::IfThenElseZero(mask, lit.z))};
        area = hn::Add(area, hn::IfThenElseZero(mask, hn::LoadU(d, texels.area)));
        members += count;
    }
    HWY_INLINE void one(std::uint32_t cluster, const Texels& texels, std::size_t lane, std::size_t) {
        const glm::dvec3 to(texels.position[lane] - origins[cluster]), lit(texels.flux[lane]);
        const double by = luminance(texels.flux[lane]);
        const ClusterSum single{to * by, glm::dvec3(texels.normal[lane]) * by, lit, by, glm::dot(to, to) * by, texels.area[lane],
                                1};
        sums[cluster] += single;
    }
    HWY_INLINE void begin(std::uint32_t cluster) {
        const Vector zero = hn::Zero(Tag());
        position = normal = flux = {zero, zero, zero};
        weight = square = area = zero;
        members = 0;
        current = cluster;
        origin = same_vector(origins[cluster]);
    }
    HWY_INLINE static double sum(Vector v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(Tag(), v))); }
    HWY_INLINE static glm::dvec3 sum(const Vec3& v) { return {sum(v.x), sum(v.y), sum(v.z)}; }
    HWY_INLINE void end() {
        if (current == no_virtual_light) return;
        ClusterSum& to = sums[current];
        to.position += sum(position), to.normal += sum(normal), to.flux += sum(flux);
        to.weight += sum(weight), to.square += sum(square), to.area += sum(area), to.members += members;
    }
};

struct Picking {
    const TypicalPlace* places;
    PickedTexel* picked;
    Vector sign;
    std::uint32_t current = no_virtual_light;
    Vec3 place{}, normal{};
    Vector spread2{}, least{};
    hn::Vec<Unsigned> winner{};

    HWY_INLINE void same(std::uint32_t cluster, LaneMask mask, std::uint32_t, const Texels& texels, std::size_t first) {
        if (cluster != current) end(), begin(cluster);
        const Unsigned du;
        const Vec3 to = difference(load_vectors(texels.position), place), turn = difference(load_vectors(texels.normal), normal);
        const Vector distance = hn::Mul(sign, hn::MulAdd(dot(turn, turn), spread2, dot(to, to)));
        const auto nearer = hn::And(mask, hn::Lt(distance, least));
        least = hn::IfThenElse(nearer, distance, least);
        winner = hn::IfThenElse(hn::RebindMask(du, nearer), hn::Iota(du, static_cast<std::uint32_t>(first)), winner);
    }
    HWY_INLINE void one(std::uint32_t cluster, const Texels& texels, std::size_t lane, std::size_t number) {
        const TypicalPlace& at = places[cluster];
        const vec3 to = texels.position[lane] - at.position, turn = texels.normal[lane] - at.normal;
        const float distance = hn::GetLane(sign) * std::fma(glm::dot(turn, turn), at.spread2, glm::dot(to, to));
        if (distance < picked[cluster].distance) picked[cluster] = {distance, static_cast<std::uint32_t>(number)};
    }
    HWY_INLINE void begin(std::uint32_t cluster) {
        least = hn::Inf(Tag());
        winner = hn::Set(Unsigned(), ~0U);
        current = cluster;
        place = same_vector(places[cluster].position), normal = same_vector(places[cluster].normal);
        spread2 = hn::Set(Tag(), places[cluster].spread2);
    }
    HWY_INLINE void end() {
        if (current == no_virtual_light) return;
        const Tag d;
        const Unsigned du;
        const Vector best = hn::MinOfLanes(d, least);
        PickedTexel& to = picked[current];
        if (!(hn::GetLane(best) < to.distance)) return;
        const auto first = hn::IfThenElse(hn::RebindMask(du, hn::Eq(least, best)), winner, hn::Set(du, ~0U));
        to = {hn::GetLane(best), hn::GetLane(hn::MinOfLanes(du, first))};
    }
};

void sum_range(const TexelRange& range, const vec3* origins, ClusterSum* sums) {
    // So many at a time are summed in single precision.
    constexpr std::size_t most = 4096;
    for (std::size_t begin = range.begin; begin < range.end; begin += most) {
        Summing summing{origins, sums};
        for_clusters({range.map, range.cluster, range.first, begin, std::min(begin + most, range.end)}, summing);
    }
}
void pick_range(const TexelRange& range, const TypicalPlace* places, bool furthest, PickedTexel* picked) {
    Picking picking{places, picked, hn::Set(Tag(), furthest ? -1.0f : 1.0f)};
    for_clusters(range, picking);
}

void extent_of(const ReflectiveShadowMap& map, std::size_t begin, std::size_t end, LitExtent& extent) {
    const Tag d;
    const std::size_t lanes = hn::Lanes(d);
    const Vector inf = hn::Inf(d), zero = hn::Zero(d);
    Vec3 lower{inf, inf, inf}, upper = negated(lower);
    Vector largest = zero;
    std::size_t i = begin;
    for (; i + lanes <= end; i += lanes) {
        const Vec3 flux = load_vectors(map.flux.data() + i), at = load_vectors(map.position.data() + i);
        const Vector most = hn::Max(flux.x, hn::Max(flux.y, flux.z));
        const auto lit = hn::Gt(most, zero);
        largest = hn::Max(largest, most);
        const Vec3 low = choose(lit, at, lower), high = choose(lit, at, upper);
        lower = {hn::Min(lower.x, low.x), hn::Min(lower.y, low.y), hn::Min(lower.z, low.z)};
        upper = {hn::Max(upper.x, high.x), hn::Max(upper.y, high.y), hn::Max(upper.z, high.z)};
    }
    const auto least_of = [&](Vector v) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(d, v)); };
    const auto most_of = [&](Vector v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, v)); };
    extent.bounds.lower = vec3(least_of(lower.x), least_of(lower.y), least_of(lower.z));
    extent.bounds.upper = vec3(most_of(upper.x), most_of(upper.y), most_of(upper.z));
    extent.largest = most_of(largest);
    for (; i < end; ++i) {
        const float most = max_component(map.flux[i]);
        if (most > 0.0f) extent.bounds.add(map.position[i]), extent.largest = std::max(extent.largest, most);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(sum_range);
HWY_EXPORT(pick_range);
HWY_EXPORT(extent_of);

void add_texels(const TexelRange& texels, std::span<const vec3> origins, std::span<ClusterSum> sums) {
    HWY_DYNAMIC_DISPATCH(sum_range)(texels, origins.data(), sums.data());
}
void pick_texels(const TexelRange& texels, std::span<const TypicalPlace> places, bool furthest, std::span<PickedTexel> picked) {
    HWY_DYNAMIC_DISPATCH(pick_range)(texels, places.data(), furthest, picked.data());
}
LitExtent lit_extent(const ReflectiveShadowMap& map, std::size_t begin, std::size_t end) {
    LitExtent extent;
    HWY_DYNAMIC_DISPATCH(extent_of)(map, begin, end, extent);
    return extent;
}

}  // namespace interreflect
#endif
