/// What was read from a file, before anything trusts its numbers.
#pragma once
#include "data/light_caches.h"
#include "data/scene.h"
#include "surfels/cluster/post_order.h"

namespace interreflect {

/// std::invalid_argument that names what is wrong: arrays of different lengths, numbers that point nowhere, nodes that are no
/// tree in post-order, places and areas that are not finite.
void check_stored(const ClusteredSurfels& surfels, const Scene& scene);
void check_stored(const CacheSites& sites, const Scene& scene);
void check_stored(const CacheLinks& links, const CacheSites& sites, const ClusteredSurfels& surfels);
void check_stored(const LinkCandidates& links, const CacheSites& sites, const ClusteredSurfels& surfels);

/// What follows from the arrays of a file, which must be sound.
void complete(ClusteredSurfels& surfels, const Scene& scene);
void complete(CacheSites& sites, const Scene& scene);

}  // namespace interreflect
