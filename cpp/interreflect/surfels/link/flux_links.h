#pragma once
#include <cstdint>
#include <span>

#include "data/light_caches.h"
#include "data/scene.h"
#include "data/surfels.h"
#include "surfels/cluster/post_order.h"
#include "surfels/link/link_knobs.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Every frame chooses a cut of its own: the node that may bring a cache most light is replaced by its children until there are
/// as many links as wanted, and what brings none has no link. The paper names it as future work: "the number of links could be
/// reduced based on the current flux at runtime". It chooses out of a larger cut by solid angle, stored as cones with all nodes
/// above it.
struct FluxLinks : LinkKnobs {
    int candidates = 512;

    bool operator==(const FluxLinks&) const = default;
    static constexpr auto description = describe(
        "FluxLinks", "Links chosen in every frame by the light that they bring, out of more that are stored as cones.",
        Source{"Jendersie et al. 2016", "6, future work"},
        std::tuple_cat(LinkKnobs::params,
                       std::tuple{Param{"candidates", &FluxLinks::candidates,
                                        "nodes by solid angle, stored with those above them, that a cut can at most consist of",
                                        Unit::none, between(1, 32768)}}));
};

/// What frames choose from: of every cache a binary tree over `candidates` links. std::invalid_argument where it would need more
/// than 4 GiB.
LinkCandidates link(const FluxLinks& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                    const Intersector& intersector);

/// At most `links` of them for every cache, best first by solid angle times the luma of the brightest of their surfels: what a
/// link brings at most. used: caches that anything reads, the others get no links; empty: all are. std::invalid_argument where
/// candidates and light do not belong together.
CacheLinks choose_links(const FluxLinks& technique, const LinkCandidates& candidates, const SurfelTree& tree,
                        const NodeLight& light, std::span<const std::uint8_t> used = {});

}  // namespace interreflect
