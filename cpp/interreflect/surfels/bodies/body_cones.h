#pragma once
#include "data/light_caches.h"
#include "data/scene.h"
#include "data/surfels.h"
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "surfels/cluster/post_order.h"
#include "visibility/intersector.h"
#include "voxels/march/march_knobs.h"

namespace interreflect {

/// A cone along every link through voxels of the bodies alone: what blocks it takes the share of the link's
/// light that it covers, and sends what its voxels reflect of direct light. The paper names it as future work: "the missing
/// shadows and reflections of dynamic objects could be included by a voxel cone tracing approach. This is possible with a
/// voxelization of the dynamic parts only because shadow and reflections of everything else are already included". A cache of a
/// grid that a body has moved over keeps its light: it lights the body's own surface. A surface is a layer of voxels one thick,
/// between which opacity falls off linearly: up to exp(-2 density) of the light comes through it, and exp(-4 density)
/// through the two layers of a solid body.
struct BodyCones : MarchKnobs {
    int resolution = 64;
    double aperture = 0.25;

    BodyCones() : MarchKnobs{} {}  // g++ 12 takes the implicit one's strings for uninitialized
    bool operator==(const BodyCones&) const = default;
    static constexpr auto description = describe(
        "BodyCones", "A cone along every link through voxels of the bodies, which block the link's light and send their own.",
        Source{"Jendersie et al. 2016", "6, future work"},
        std::tuple_cat(std::tuple{Param{"resolution", &BodyCones::resolution, "voxels along the scene's longest side",
                                        Unit::voxels, between(2, 1024)},
                                  Param{"aperture", &BodyCones::aperture,
                                        "half angle of a cone over its link's: wide cones see a body larger than it is",
                                        Unit::none, between(0, 1)}},
                       MarchKnobs::params));
};

/// Changes the light of caches that came through `links`. pyramids: of the bodies, where they are; without emission. reflect:
/// whether bodies send light. std::invalid_argument where links, light, sites and tree do not belong together, or where projected
/// links have one band and do not tell their direction.
Counts shadow_links(const BodyCones& technique, LightCaches& caches, const CacheLinks& links, const NodeLight& light,
                    const CacheSites& sites, const ClusteredSurfels& surfels, Pyramids pyramids, const Scene& scene,
                    const Intersector& intersector, bool reflect);

}  // namespace interreflect
