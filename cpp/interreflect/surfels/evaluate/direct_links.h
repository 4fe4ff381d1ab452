#pragma once
#include "data/gbuffer.h"
#include "data/light_caches.h"
#include "data/scene.h"
#include "data/surfels.h"
#include "data/technique.h"
#include "surfels/evaluate/surfel_light.h"
#include "surfels/link/all_surfels.h"

namespace interreflect {

/// Each link of the caches about a pixel sends its light along its mean direction, and the pixel's surface reflects it by its own
/// BRDF: no spherical harmonics, but that projected links tell their direction by their first four coefficients.
struct DirectLinks {
    bool operator==(const DirectLinks&) const = default;
    static constexpr auto description = describe("DirectLinks", "The BRDF itself over all links of the caches about a pixel.",
                                                 Source{"Jendersie et al. 2016", "3.1, before the projection"});
};

/// std::invalid_argument where links and light do not belong together, or where projected links have one band.
SurfelLight evaluate(const DirectLinks& technique, const CacheLinks& links, const NodeLight& light, const CacheSites& sites,
                     const GBuffer& gbuffer, const Scene& scene);
/// Over surfels themselves, in place of links: each cache that a pixel reads sends rays to them, as `light_caches` does of
/// AllSurfels.
SurfelLight evaluate(const DirectLinks& technique, const AllSurfels& links, const CacheSites& sites,
                     const ClusteredSurfels& surfels, const NodeLight& light, const GBuffer& gbuffer, const Scene& scene,
                     const Intersector& intersector, std::uint32_t seed);

}  // namespace interreflect
