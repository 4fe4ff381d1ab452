#include "surfels/link/linked_caches.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr std::size_t most_bytes = std::size_t{4} << 30U;
constexpr std::size_t caches_a_block = 32;

}  // namespace

float unit_of_links(const ClusteredSurfels& surfels, const LinkKnobs& knobs) {
    const std::size_t n = surfels.surfels.size();
    if (knobs.pull == "radiosity" || n == 0) return 1.0f;
    const float mean = surfels.tree.area[surfels.tree.nodes() - 1] / static_cast<float>(n);
    return 1.0f / (1024.0f * mean);
}

CacheLinks make_links(const LinkKnobs& knobs, CacheLinks::Kind kind, const CacheSites& sites, const ClusteredSurfels& surfels) {
    const bool cones = kind == CacheLinks::Kind::cones;
    const std::size_t count = sites.size() * static_cast<std::size_t>(knobs.links);
    const std::size_t each = coefficients_of(knobs.bands);
    const std::size_t bytes = cones ? sizeof(ConeLink) : sizeof(std::uint32_t) + each * sizeof(std::uint16_t);
    if (count > most_bytes / bytes)
        throw std::invalid_argument("links: " + std::to_string(sites.size()) + " caches with " + std::to_string(knobs.links) +
                                    " links of " + std::to_string(bytes) + " bytes each are more than 4 GiB");
    CacheLinks links;
    links.kind = kind, links.per_cache = surfels.tree.nodes() > 0 ? knobs.links : 0, links.bands = knobs.bands;
    links.unit = unit_of_links(surfels, knobs), links.radiosity = knobs.pull == "radiosity";
    links.caches = sites.size(), links.nodes = surfels.tree.nodes();
    if (cones) {
        links.cones = Buffer<ConeLink>(count + 16, ConeLink{0, 0, 0, 0, 0});  // a vector that starts at the last may read on
    } else {
        links.node = Buffer<std::uint32_t>(count, 0U);
        // A vector that starts at the last coefficient may read on.
        links.coefficients = Buffer<std::uint16_t>(count * each + 64, std::uint16_t{0});
    }
    return links;
}

Counts for_each_cut(const LinkKnobs& knobs, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                    const Intersector& intersector, const std::function<void(const CacheCut&)>& store) {
    const VisibleSurfels visible(surfels, scene, intersector, {knobs.rays, knobs.near_rays});
    std::vector<Counts> counts((sites.size() + caches_a_block - 1) / caches_a_block);
    parallel_blocks(sites.size(), caches_a_block, [&](std::size_t begin, std::size_t end) {
        LinkCut cut(surfels.tree);
        SeenSurfels seen(surfels.surfels.size());
        Counts& mine = counts[begin / caches_a_block];
        for (std::size_t cache = begin; cache < end; ++cache) {
            visible.look(sites, cache, {}, 1.0f, seen, mine);
            const auto nodes = cut.choose(seen.solid_angle, knobs.links);
            store({cache, nodes, seen, cut});
            mine.links += nodes.size();
        }
    });
    Counts sum;
    for (const Counts& one : counts) sum += one;
    return sum;
}

}  // namespace interreflect
