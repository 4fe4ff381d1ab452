/// Finding the links of all caches.
#pragma once
#include <functional>

#include "data/light_caches.h"
#include "surfels/link/link_cut.h"
#include "surfels/link/link_knobs.h"
#include "surfels/link/visible_surfels.h"

namespace interreflect {

/// A cache's cut, and what it was made from.
struct CacheCut {
    std::size_t cache;
    std::span<const std::uint32_t> nodes;
    const SeenSurfels& seen;
    const LinkCut& cut;

    /// Calls add(direction, solid angle) for all that is seen of a node's surfels.
    template <class Add>
    void for_each_direction(const ClusteredSurfels& surfels, std::uint32_t node, const Add& add) const {
        const std::uint32_t end = surfels.tree.leaf_end[node];
        for (std::uint32_t i = end - surfels.tree.leaves[node]; i < end; ++i)
            seen.for_each_direction(i, surfels.surfels.position[i], add);
    }
};

/// 1 / what coefficients of a tree's links are multiplied by, so that as half floats they keep their digits at any scale of the
/// scene: for flux a thousand surfels' areas, for radiosity 1.
float unit_of_links(const ClusteredSurfels& surfels, const LinkKnobs& knobs);

/// Empty links for all caches. std::invalid_argument where they would need more than 4 GiB.
CacheLinks make_links(const LinkKnobs& knobs, CacheLinks::Kind kind, const CacheSites& sites, const ClusteredSurfels& surfels);

/// Calls store for every cache, from all threads; returns the counts of all.
Counts for_each_cut(const LinkKnobs& knobs, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                    const Intersector& intersector, const std::function<void(const CacheCut&)>& store);

}  // namespace interreflect
