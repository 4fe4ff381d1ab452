#pragma once
#include "data/light_caches.h"
#include "data/scene.h"
#include "surfels/cluster/post_order.h"
#include "surfels/link/link_knobs.h"
#include "surfels/link/linked_caches.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Each link holds the visible part of its patch in spherical harmonics, over pi: coefficients as half floats [Jendersie et al.
/// 2016, 3.1 and 4.5]. To light a cache is to sum them up, times what the patches send on.
struct ShLinks : LinkKnobs {
    bool operator==(const ShLinks&) const = default;
    static constexpr auto description =
        describe("ShLinks", "Links that hold the visible part of a patch in spherical harmonics.",
                 Source{"Jendersie et al. 2016", "3.1, equation 2, corrected; 4.5"}, LinkKnobs::params);
};

/// std::invalid_argument where the links would need more than 4 GiB.
CacheLinks link(const ShLinks& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                const Intersector& intersector);

/// Writes one cache's links, as many bands as `links` have.
void project_cut(const CacheCut& cache, const ClusteredSurfels& surfels, CacheLinks& links);

}  // namespace interreflect
