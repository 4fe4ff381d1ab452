/// Links as cones in space.
#pragma once
#include <cmath>

#include "data/light_caches.h"
#include "data/surfels.h"
#include "math/half.h"
#include "math/octahedral_map.h"
#include "math/spherical_harmonics.h"
#include "surfels/cluster/post_order.h"

namespace interreflect {

struct LinkCone {
    std::uint32_t node = 0;
    vec3 direction{0};      // unit; (0, 0, 0): there is no link
    float solid_angle = 0;  // sr
};

/// Link `i` of the list. Projected links tell their direction by coefficients of the second band.
inline LinkCone cone_of(const CacheLinks& links, std::size_t i, const SurfelTree& tree) {
    if (links.kind == CacheLinks::Kind::cones) {
        const ConeLink& link = links.cones[i];
        if (link.one_less_cos == 0) return {};
        return {link.node, octahedral_direction({static_cast<float>(link.x) / 65535.0f, static_cast<float>(link.y) / 65535.0f}),
                zonal_cone(0, from_half(link.one_less_cos))};
    }
    const std::uint16_t* c = links.coefficients.data() + i * coefficients_of(links.bands);
    const vec3 towards(from_half(c[3]), from_half(c[1]), from_half(c[2]));
    const float length = glm::length(towards), constant = 0.5f / std::sqrt(pi);
    if (!(length > 0.0f)) return {};
    const std::uint32_t node = links.node[i];
    const float per_flux = pi * links.unit * (links.radiosity ? 1.0f : tree.area[node]);
    return {node, towards / length, from_half(c[0]) / constant * per_flux};
}

/// Adds the link's coefficients, times a light of its node, to sums of three colours, each of 64.
inline void add_link(const CacheLinks& links, std::size_t i, const LinkCone& cone, const vec3& light, int bands, float* colours) {
    const auto add = [&](int k, float value) {
        for (int colour = 0; colour < 3; ++colour) colours[64 * colour + k] += value * light[colour];
    };
    if (links.kind == CacheLinks::Kind::cones) {
        const float factor = from_half(links.cones[i].factor) * links.unit, narrow = from_half(links.cones[i].one_less_cos);
        float zonal[most_bands];
        for (int l = 0; l < bands; ++l) zonal[l] = zonal_cone(l, narrow) * factor;
        spherical_harmonics(cone.direction, bands, [&](int k, float y) {
            add(k, y * zonal[static_cast<int>(std::sqrt(static_cast<float>(k) + 0.5f))]);
        });
    } else {
        const std::uint16_t* c = links.coefficients.data() + i * coefficients_of(links.bands);
        for (int k = 0; k < bands * bands; ++k) add(k, from_half(c[k]) * links.unit);
    }
}

}  // namespace interreflect
