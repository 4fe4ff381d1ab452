#include "surfels/link/all_surfels.h"

#include <vector>

#include "math/parallel.h"
#include "math/rng.h"
#include "math/spherical_harmonics.h"
#include "surfels/light_kernel.h"
#include "surfels/link/visible_surfels.h"

namespace interreflect {
namespace {

constexpr std::size_t caches_a_block = 32;

/// One surfel of every stratum of their order; empty: all.
void choose(std::size_t surfels, int samples, Rng& random, std::vector<std::uint32_t>& chosen) {
    chosen.clear();
    const auto strata = static_cast<std::size_t>(samples);
    if (strata == 0 || strata >= surfels) return;
    for (std::size_t k = 0; k < strata; ++k) {
        const double at = (static_cast<double>(k) + static_cast<double>(random.uniform())) / static_cast<double>(strata);
        chosen.push_back(static_cast<std::uint32_t>(at * static_cast<double>(surfels)));
    }
}

}  // namespace

LightCaches light_caches(const AllSurfels& technique, const CacheSites& sites, const ClusteredSurfels& surfels,
                         const NodeLight& light, const CacheFormat& format, const Scene& scene, const Intersector& intersector,
                         std::uint32_t seed) {
    LightCaches made = make_light_caches(sites.size(), format);
    const std::size_t n = surfels.surfels.size();
    const VisibleSurfels visible(surfels, scene, intersector, {1, technique.near_rays});
    std::vector<Counts> counts((sites.size() + caches_a_block - 1) / caches_a_block);
    parallel_blocks(sites.size(), caches_a_block, [&](std::size_t begin, std::size_t end) {
        SeenSurfels seen(n);
        std::vector<std::uint32_t> chosen;
        for (std::size_t cache = begin; cache < end; ++cache) {
            Rng random(seed, static_cast<std::uint32_t>(cache), 0xa11U);
            choose(n, technique.samples, random, chosen);
            const float each = chosen.empty() ? 1.0f : static_cast<float>(n) / static_cast<float>(chosen.size());
            visible.look(sites, cache, chosen, each, seen, counts[begin / caches_a_block]);
            alignas(64) float colours[3][most_bands * most_bands] = {};
            for (std::uint32_t i = 0; i < n; ++i) {
                const vec3 radiance =
                    light.value[surfels.tree.node[i]] / (pi * (light.radiosity ? 1.0f : surfels.surfels.area[i]));
                seen.for_each_direction(i, surfels.surfels.position[i], [&](const vec3& direction, float solid_angle) {
                    spherical_harmonics(direction, format.bands, [&](int c, float y) {
                        for (int colour = 0; colour < 3; ++colour) colours[colour][c] += radiance[colour] * solid_angle * y;
                    });
                });
            }
            store_cache(made, cache, colours[0], colours[1], colours[2]);
        }
    });
    for (const Counts& one : counts) made.counts += one;
    return made;
}

}  // namespace interreflect
