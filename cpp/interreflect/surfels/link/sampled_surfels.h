/// The light of surfels themselves at a cache.
#pragma once
#include <vector>

#include "surfels/link/all_surfels.h"
#include "surfels/link/visible_surfels.h"

namespace interreflect {

/// Memory that goes from one cache to the next.
struct SampledCache {
    SeenSurfels seen;
    std::vector<std::uint32_t> chosen;

    explicit SampledCache(std::size_t surfels) : seen(surfels) {}
};

class SampledSurfels {
  public:
    SampledSurfels(const AllSurfels& technique, const ClusteredSurfels& surfels, const NodeLight& light, const Scene& scene,
                   const Intersector& intersector, std::uint32_t seed);

    /// Calls add(direction, radiance, solid angle) for what the cache sees; which surfels it looks for depends on cache and seed
    /// alone.
    template <class Add>
    void each_beam(const CacheSites& sites, std::size_t cache, SampledCache& memory, Counts& counts, const Add& add) const {
        look(sites, cache, memory, counts);
        const Surfels& all = surfels_.surfels;
        for (std::uint32_t i = 0; i < all.size(); ++i) {
            const vec3 radiance = light_.at(surfels_.tree.node[i]) / (pi * (light_.radiosity ? 1.0f : all.area[i]));
            memory.seen.for_each_direction(
                i, all.position[i], [&](const vec3& direction, float solid_angle) { add(direction, radiance, solid_angle); });
        }
    }

  private:
    void look(const CacheSites& sites, std::size_t cache, SampledCache& memory, Counts& counts) const;

    const ClusteredSurfels& surfels_;
    const NodeLight& light_;
    VisibleSurfels visible_;
    int samples_;
    std::uint32_t seed_;
};

}  // namespace interreflect
