#include "surfels/link/sh_links.h"

#include <array>

#include "math/half.h"
#include "math/spherical_harmonics.h"

namespace interreflect {

void project_cut(const CacheCut& cache, const ClusteredSurfels& surfels, CacheLinks& links) {
    const int count = links.bands * links.bands;
    std::size_t at = cache.cache * static_cast<std::size_t>(links.per_cache);
    for (const std::uint32_t node : cache.nodes) {
        std::array<float, most_bands * most_bands> sum{};
        cache.for_each_direction(surfels, node, [&](const vec3& direction, float weight) {
            spherical_harmonics(direction, links.bands, [&](int k, float y) { sum[static_cast<std::size_t>(k)] += weight * y; });
        });
        const float scale = 1.0f / (pi * links.unit * (links.radiosity ? 1.0f : surfels.tree.area[node]));
        links.node[at] = node;
        for (int k = 0; k < count; ++k)
            links.coefficients[at * static_cast<std::size_t>(count) + static_cast<std::size_t>(k)] =
                to_half(sum[static_cast<std::size_t>(k)] * scale);
        ++at;
    }
}

CacheLinks link(const ShLinks& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                const Intersector& intersector) {
    CacheLinks links = make_links(technique, CacheLinks::Kind::projected, sites, surfels);
    links.counts = for_each_cut(technique, sites, surfels, scene, intersector,
                                [&](const CacheCut& cache) { project_cut(cache, surfels, links); });
    return links;
}

}  // namespace interreflect
