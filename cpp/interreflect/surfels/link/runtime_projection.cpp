#include "surfels/link/runtime_projection.h"

#include <algorithm>
#include <cmath>

#include "math/half.h"
#include "math/octahedral_map.h"
#include "math/spherical_harmonics.h"

namespace interreflect {
namespace {

ConeLink cone_link(std::uint32_t node, const vec3& towards, float solid_angle, float scale) {
    const float length = glm::length(towards);
    const vec2 at = octahedral_square(length > 0.0f ? towards / length : vec3(0, 0, 1));
    ConeLink link{node, 0, 0, static_cast<std::uint16_t>(std::lround(at.x * 65535.0f)),
                  static_cast<std::uint16_t>(std::lround(at.y * 65535.0f))};
    // The smallest normal half float: a cone of less is as sharp as any.
    const float narrow = std::max(solid_angle / (2.0f * pi), 0x1p-14f);
    link.one_less_cos = to_half(std::min(narrow, 2.0f));
    link.factor = to_half(scale * solid_angle / zonal_cone(0, from_half(link.one_less_cos)));
    return link;
}

}  // namespace

void cut_to_cones(const CacheCut& cache, const ClusteredSurfels& surfels, CacheLinks& links) {
    std::size_t at = cache.cache * static_cast<std::size_t>(links.per_cache);
    for (const std::uint32_t node : cache.nodes) {
        vec3 towards(0);
        cache.for_each_direction(surfels, node, [&](const vec3& direction, float weight) { towards += direction * weight; });
        const float scale = 1.0f / (pi * links.unit * (links.radiosity ? 1.0f : surfels.tree.area[node]));
        links.cones[at++] = cone_link(node, towards, cache.cut.solid_angle(node), scale);
    }
}

CacheLinks link(const RuntimeProjection& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                const Intersector& intersector) {
    CacheLinks links = make_links(technique, CacheLinks::Kind::cones, sites, surfels);
    links.counts = for_each_cut(technique, sites, surfels, scene, intersector,
                                [&](const CacheCut& cache) { cut_to_cones(cache, surfels, links); });
    return links;
}

}  // namespace interreflect
