#include "surfels/link/sampled_surfels.h"

#include "math/rng.h"

namespace interreflect {
namespace {

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

SampledSurfels::SampledSurfels(const AllSurfels& technique, const ClusteredSurfels& surfels, const NodeLight& light,
                               const Scene& scene, const Intersector& intersector, std::uint32_t seed)
    : surfels_(surfels),
      light_(light),
      visible_(surfels, scene, intersector, {1, technique.near_rays}),
      samples_(technique.samples),
      seed_(seed) {}

void SampledSurfels::look(const CacheSites& sites, std::size_t cache, SampledCache& memory, Counts& counts) const {
    const std::size_t n = surfels_.surfels.size();
    Rng random(seed_, static_cast<std::uint32_t>(cache), 0xa11U);
    choose(n, samples_, random, memory.chosen);
    const float each = memory.chosen.empty() ? 1.0f : static_cast<float>(n) / static_cast<float>(memory.chosen.size());
    visible_.look(sites, cache, memory.chosen, each, memory.seen, counts);
}

}  // namespace interreflect
