#pragma once
#include "data/light_caches.h"
#include "data/scene.h"
#include "surfels/cluster/post_order.h"
#include "surfels/link/link_knobs.h"
#include "surfels/link/linked_caches.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Each link is a cone of the patch's visible solid angle about the mean direction to it, in 12 bytes whatever the bands; it is
/// projected when a cache is lit [Jendersie et al. 2016, 4.6]. The factor makes up for what half floats make of the angle, and
/// holds equation 2's 1/pi, which the paper's does not (ERRATA).
struct RuntimeProjection : LinkKnobs {
    bool operator==(const RuntimeProjection&) const = default;
    static constexpr auto description =
        describe("RuntimeProjection", "Links that are cones, projected to spherical harmonics when a cache is lit.",
                 Source{"Jendersie et al. 2016", "4.6, equation 6, appendix C, corrected"}, LinkKnobs::params);
};

/// std::invalid_argument where the links would need more than 4 GiB.
CacheLinks link(const RuntimeProjection& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                const Intersector& intersector);

/// Writes one cache's links.
void cut_to_cones(const CacheCut& cache, const ClusteredSurfels& surfels, CacheLinks& links);

}  // namespace interreflect
