/// Shadow links: what do bodies that move take from the light of links, and what do they send in its place?
///
///   Counts shadow_links(const Technique&, LightCaches&, const CacheLinks&, const NodeLight&, const CacheSites&,
///                     const ClusteredSurfels&, Pyramids, const Scene&, const Intersector&);
///
/// Links are precomputed without bodies. Exact counterpart: AllSurfels (link), whose rays meet bodies in every frame; they bring
/// shadows and no light of bodies.
#pragma once
#include <variant>

#include "surfels/bodies/body_cones.h"

namespace interreflect {
using ShadowLinks = std::variant<BodyCones>;
}
