#include "surfels/sites/pixel_caches.h"

#include <algorithm>

namespace interreflect {

CacheSites pixel_sites(const GBuffer& g) {
    std::size_t n = 0;
    for (std::size_t pixel = 0; pixel < g.pixels(); ++pixel) n += g.hit(pixel) ? 1 : 0;
    CacheSites sites{Buffer<vec3>(n), Buffer<vec3>(n), Buffer<float>(n), {}, {}, true, {}};
    std::size_t next = 0;
    for (std::size_t pixel = 0; pixel < g.pixels(); ++pixel)
        if (g.hit(pixel)) {
            sites.position[next] = g.position[pixel];
            sites.normal[next] = g.geometric_normal[pixel];
            sites.offset[next++] = g.offset[pixel];
        }
    sites.counts.caches = n;
    return sites;
}

}  // namespace interreflect
