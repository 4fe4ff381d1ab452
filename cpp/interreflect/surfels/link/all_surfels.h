#pragma once
#include "data/light_caches.h"
#include "data/scene.h"
#include "data/technique.h"
#include "surfels/cluster/post_order.h"
#include "surfels/light_caches.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Nothing is clustered or stored: rays from every cache to surfels chosen anew in every frame, or to all of them. An unbiased
/// estimate of the light of all surfels; the choice is stratified over the tree's order, in which neighbours lie together.
struct AllSurfels {
    int samples = 1024;
    int bands = 4;
    int near_rays = 512;

    bool operator==(const AllSurfels&) const = default;
    static constexpr auto description =
        describe("AllSurfels", "Rays from every cache to surfels chosen anew in every frame; nothing is clustered or stored.",
                 Source{"Jendersie et al. 2016", "equation 1, without links"},
                 Param{"samples", &AllSurfels::samples, "surfels for every cache; 0: all", Unit::samples, between(0, 1 << 22)},
                 Param{"bands", &AllSurfels::bands, "of the caches' spherical harmonics", Unit::none, between(1, 8)},
                 Param{"near_rays", &AllSurfels::near_rays,
                       "directions in which a cache looks for what is nearer than four surfels' spacings; 0: rays to surfels "
                       "alone",
                       Unit::samples, between(0, 65536)});
};

/// used: as for links; empty: all.
LightCaches light_caches(const AllSurfels& technique, const CacheSites& sites, const ClusteredSurfels& surfels,
                         const NodeLight& light, const CacheFormat& format, const Scene& scene, const Intersector& intersector,
                         std::uint32_t seed, std::span<const std::uint8_t> used = {});

}  // namespace interreflect
