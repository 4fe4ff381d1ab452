#include "surfels/link/all_surfels.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"
#include "math/spherical_harmonics.h"
#include "surfels/light_kernel.h"
#include "surfels/link/sampled_surfels.h"

namespace interreflect {
namespace {

constexpr std::size_t caches_a_block = 32;

}  // namespace

LightCaches light_caches(const AllSurfels& technique, const CacheSites& sites, const ClusteredSurfels& surfels,
                         const NodeLight& light, const CacheFormat& format, const Scene& scene, const Intersector& intersector,
                         std::uint32_t seed, std::span<const std::uint8_t> used) {
    if (!used.empty() && used.size() != sites.size())
        throw std::invalid_argument("light_caches: `used` tells of " + std::to_string(used.size()) + " caches, there are " +
                                    std::to_string(sites.size()));
    LightCaches made = make_light_caches(sites.size(), format);
    const SampledSurfels sampled(technique, surfels, light, scene, intersector, seed);
    std::vector<Counts> counts((sites.size() + caches_a_block - 1) / caches_a_block);
    parallel_blocks(sites.size(), caches_a_block, [&](std::size_t begin, std::size_t end) {
        SampledCache memory(surfels.surfels.size());
        for (std::size_t cache = begin; cache < end; ++cache) {
            alignas(64) float colours[3][most_bands * most_bands] = {};
            if (used.empty() || used[cache] != 0)
                sampled.each_beam(sites, cache, memory, counts[begin / caches_a_block],
                                  [&](const vec3& direction, const vec3& radiance, float solid_angle) {
                                      spherical_harmonics(direction, format.bands, [&](int c, float y) {
                                          for (int colour = 0; colour < 3; ++colour)
                                              colours[colour][c] += radiance[colour] * solid_angle * y;
                                      });
                                  });
            store_cache(made, cache, colours[0], colours[1], colours[2]);
        }
    });
    for (const Counts& one : counts) made.counts += one;
    return made;
}

}  // namespace interreflect
