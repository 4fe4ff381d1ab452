#include "surfels/evaluate/direct_links.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "math/half.h"
#include "math/octahedral_map.h"
#include "math/parallel.h"
#include "math/spherical_harmonics.h"
#include "surfels/evaluate/beam.h"
#include "surfels/evaluate/cache_finder.h"
#include "surfels/light_caches.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16;  // pixels

Beam beam_of(const ConeLink& link, const CacheLinks& links, const NodeLight& light) {
    const float scale = from_half(link.factor) * zonal_cone(0, from_half(link.one_less_cos)) * links.unit;
    return {octahedral_direction({static_cast<float>(link.x) / 65535.0f, static_cast<float>(link.y) / 65535.0f}),
            light.at(link.node) * scale};
}

/// The first coefficient is the solid angle's times y_0; the next three point along the mean direction.
Beam beam_of(std::size_t link, const CacheLinks& links, const NodeLight& light) {
    const std::uint16_t* c = links.coefficients.data() + link * coefficients_of(links.bands);
    const vec3 towards(from_half(c[3]), from_half(c[1]), from_half(c[2]));
    const float length = glm::length(towards), constant = 0.5f / std::sqrt(pi);
    if (!(length > 0.0f)) return {};
    return {towards / length, light.at(links.node[link]) * (from_half(c[0]) / constant * links.unit)};
}

void check(const CacheLinks& links, const NodeLight& light, const CacheSites& sites) {
    check_links(links, light);
    if (links.caches != sites.size()) throw std::invalid_argument("DirectLinks: links of another number of caches");
    if (links.kind == CacheLinks::Kind::projected && links.bands < 2)
        throw std::invalid_argument("DirectLinks: links of one band do not tell their direction");
}

}  // namespace

SurfelLight evaluate(const DirectLinks&, const CacheLinks& links, const NodeLight& light, const CacheSites& sites,
                     const GBuffer& gbuffer, const Scene& scene) {
    check(links, light, sites);
    SurfelLight made = empty_surfel_light(gbuffer);
    const CacheFinder finder(sites, gbuffer);
    const auto per_cache = static_cast<std::size_t>(links.per_cache);
    std::vector<Counts> counts(tile_count(gbuffer.width, gbuffer.height, tile_size));
    parallel_tiles(gbuffer.width, gbuffer.height, tile_size, [&](const Tile& tile) {
        NearCaches near;
        for (int y = tile.y0; y < tile.y1; ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width);
            finder.find(row + static_cast<std::size_t>(tile.x0), tile.x1 - tile.x0, near);
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel = row + static_cast<std::size_t>(x);
                const int of = x - tile.x0;
                Reflected sum;
                if (gbuffer.hit(pixel)) {
                    const PixelSurface surface(gbuffer, scene, pixel);
                    std::uint64_t used = 0;
                    for (int k = 0; k < near.slots; ++k) {
                        if (!(near.weight[k][of] > 0.0f)) continue;
                        ++used;
                        const std::size_t first = near.cache[k][of] * per_cache;
                        for (std::size_t i = first; i < first + per_cache; ++i)
                            sum.add(surface,
                                    links.kind == CacheLinks::Kind::cones ? beam_of(links.cones[i], links, light)
                                                                          : beam_of(i, links, light),
                                    near.weight[k][of]);
                    }
                    Counts& mine = counts[tile.index];
                    mine.links += used * per_cache;
                    ++(used > 0 ? mine.covered_pixels : mine.uncovered_pixels);
                }
                made.gathered.irradiance[pixel] = sum.irradiance;
                made.glossy.radiance[pixel] = sum.glossy;
            }
        }
    });
    for (const Counts& one : counts) made.counts += one;
    return made;
}

}  // namespace interreflect
