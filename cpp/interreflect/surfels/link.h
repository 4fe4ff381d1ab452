/// Link: which patches of surfels send light to each cache, and how much?
///
///   CacheLinks link(const Technique&, const CacheSites&, const ClusteredSurfels&, const Scene&, const Intersector&);
///
/// The number of links of every cache is fixed; together they cover all that it sees of the still surface. FluxLinks makes
/// LinkCandidates, from which choose_links takes every frame's. Exact counterpart: AllSurfels, which stores nothing:
/// light_caches(AllSurfels, ...) sends rays to the surfels themselves.
#pragma once
#include <variant>

#include "surfels/link/all_surfels.h"
#include "surfels/link/flux_links.h"
#include "surfels/link/runtime_projection.h"
#include "surfels/link/sh_links.h"

namespace interreflect {
using Link = std::variant<AllSurfels, ShLinks, RuntimeProjection, FluxLinks>;
}
