#include "virtual_lights/cluster/nearest_centre.h"

#include <algorithm>

#include "data/virtual_lights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "virtual_lights/cluster/nearest_centre.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline, for sixteen texels and a centre: 20 operations and two square roots, some 45 cycles, against 36 bytes of each texel,
// read once for all centres. Most centres are too far away in space: six operations.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct TexelLanes {
    Vec3 position, normal, flux;
};
HWY_INLINE Vec3 load3(const vec3* from) {
    Vec3 v;
    hn::LoadInterleaved3(Tag(), reinterpret_cast<const float*>(from), v.x, v.y, v.z);
    return v;
}
HWY_INLINE Vector squared_distance(const Vec3& a, const vec3& b) {
    const Tag d;
    const Vec3 to{hn::Sub(a.x, hn::Set(d, b.x)), hn::Sub(a.y, hn::Set(d, b.y)), hn::Sub(a.z, hn::Set(d, b.z))};
    return dot(to, to);
}

bool find_nearest(const TexelRow& row, const MetricWeights& weights, const MetricCentre* centres, std::size_t count,
                  std::uint32_t* nearest) {
    const Tag d;
    const hn::RebindToUnsigned<Tag> du;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const Vector by_position = hn::Set(d, weights.position), by_normal = hn::Set(d, weights.normal),
                 by_flux = hn::Set(d, weights.flux), scale = hn::Set(d, row.flux_scale);
    // Where the distance in space alone is more than the least of all three, by more than rounding, the other two do not matter.
    const Vector by_square = hn::Mul(by_position, by_position), slack = hn::Set(d, 1.0001f);
    alignas(64) vec3 rest[3][16];
    alignas(64) std::uint32_t found[16];
    bool strays = false;
    for (int x = 0; x < row.count; x += lanes) {
        const int left = std::min(lanes, row.count - x);
        const vec3 *position = row.position + x, *normal = row.normal + x, *flux = row.flux + x;
        if (left < lanes) {
            for (int i = 0; i < lanes; ++i) {
                const int from = std::min(i, left - 1);
                rest[0][i] = position[from], rest[1][i] = normal[from], rest[2][i] = flux[from];
            }
            position = rest[0], normal = rest[1], flux = rest[2];
        }
        const Vec3 sent = load3(flux);
        const auto lit = hn::Gt(hn::Max(sent.x, hn::Max(sent.y, sent.z)), hn::Zero(d));
        if (hn::AllFalse(d, lit)) {
            std::fill_n(nearest + x, left, no_virtual_light);
            continue;
        }
        const Vec3 texel_position = load3(position), texel_normal = load3(normal), texel_flux = scaled(sent, scale);
        const Vector column = hn::Iota(d, static_cast<float>(x));
        Vector least = hn::Set(d, 3e38f);
        Vector bound = hn::Inf(d);
        auto winner = hn::Set(du, no_virtual_light);
        for (std::size_t c = 0; c < count; ++c) {
            const MetricCentre& centre = centres[c];
            if (row.row < centre.first_row || row.row > centre.last_row) continue;
            const Vec3 facing{hn::Set(d, centre.normal.x), hn::Set(d, centre.normal.y), hn::Set(d, centre.normal.z)};
            const Vector squared = squared_distance(texel_position, centre.position);
            if (hn::AllTrue(d, hn::Gt(hn::Mul(squared, by_square), bound))) continue;
            Vector mu = hn::Mul(by_position, hn::Sqrt(squared));
            mu = hn::MulAdd(by_normal, hn::Sub(hn::Set(d, 1.0f), dot(texel_normal, facing)), mu);
            mu = hn::MulAdd(by_flux, hn::Sqrt(squared_distance(texel_flux, centre.flux)), mu);
            const auto inside = hn::And(hn::Ge(column, hn::Set(d, centre.first_x)), hn::Le(column, hn::Set(d, centre.last_x)));
            const auto nearer = hn::And(inside, hn::Lt(mu, least));
            least = hn::IfThenElse(nearer, mu, least);
            bound = hn::Mul(slack, hn::Mul(least, least));
            winner = hn::IfThenElse(hn::RebindMask(du, nearer), hn::Set(du, centre.cluster), winner);
        }
        const auto none = hn::Eq(winner, hn::Set(du, no_virtual_light));
        strays |= !hn::AllFalse(du, hn::And(none, hn::RebindMask(du, lit)));
        hn::Store(hn::IfThenElse(hn::RebindMask(du, lit), winner, hn::Set(du, no_virtual_light)), du, found);
        std::copy(found, found + left, nearest + x);
    }
    return strays;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(find_nearest);

bool nearest_centres(const TexelRow& row, const MetricWeights& weights, std::span<const MetricCentre> centres,
                     std::uint32_t* nearest) {
    return HWY_DYNAMIC_DISPATCH(find_nearest)(row, weights, centres.data(), centres.size(), nearest);
}

}  // namespace interreflect
#endif
