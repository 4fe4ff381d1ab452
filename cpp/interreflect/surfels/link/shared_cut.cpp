#include "surfels/link/shared_cut.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "math/parallel.h"

namespace interreflect {
namespace {

/// Links without their contents.
CacheLinks like(const CacheLinks& links, const LinkKnobs& knobs) {
    if (links.per_cache != (links.nodes > 0 ? knobs.links : 0) || links.radiosity != (knobs.pull == "radiosity"))
        throw std::invalid_argument("a cut of " + std::to_string(links.per_cache) + " links a cache for " +
                                    (links.radiosity ? "radiosity" : "flux") + " gives none of " + std::to_string(knobs.links) +
                                    " for " + knobs.pull);
    CacheLinks made;
    made.kind = links.kind, made.per_cache = links.per_cache, made.bands = knobs.bands;
    made.radiosity = links.radiosity, made.unit = links.unit;
    made.caches = links.caches, made.nodes = links.nodes, made.counts = links.counts;
    return made;
}

}  // namespace

SharedCut shared_cut(LinkKnobs knobs, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                     const Intersector& intersector) {
    knobs.bands = most_bands;
    SharedCut made{make_links(knobs, CacheLinks::Kind::projected, sites, surfels),
                   make_links(knobs, CacheLinks::Kind::cones, sites, surfels)};
    made.projected.counts = made.cones.counts =
        for_each_cut(knobs, sites, surfels, scene, intersector, [&](const CacheCut& cache) {
            project_cut(cache, surfels, made.projected);
            cut_to_cones(cache, surfels, made.cones);
        });
    return made;
}

CacheLinks take_links(const ShLinks& technique, const SharedCut& cut) {
    CacheLinks links = like(cut.projected, technique);
    const std::size_t all = most_bands * most_bands, few = coefficients_of(technique.bands);
    const std::size_t count = cut.projected.node.size();
    links.node = Buffer<std::uint32_t>(count);
    std::ranges::copy(cut.projected.node, links.node.begin());
    // A vector that starts at the last coefficient may read on.
    links.coefficients = Buffer<std::uint16_t>(count * few + 64, std::uint16_t{0});
    parallel_blocks(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            std::copy_n(cut.projected.coefficients.data() + i * all, few, links.coefficients.data() + i * few);
    });
    return links;
}

CacheLinks take_links(const RuntimeProjection& technique, const SharedCut& cut) {
    CacheLinks links = like(cut.cones, technique);
    links.cones = Buffer<ConeLink>(cut.cones.cones.size());
    std::ranges::copy(cut.cones.cones, links.cones.begin());
    return links;
}

}  // namespace interreflect
