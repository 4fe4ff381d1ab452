/// Trees from the merges that made them.
#pragma once
#include <cstdint>
#include <span>

#include "data/surfels.h"

namespace interreflect {

struct ClusteredSurfels {
    Surfels surfels;  // in the order of the tree's leaves
    SurfelTree tree;

    std::size_t bytes() const { return surfels.bytes() + tree.bytes(); }
};

/// Two nodes that become one: surfel i is node i, merge k makes node n + k, and the last one the root.
struct Merge {
    std::uint32_t left, right;
};

/// The tree of n - 1 merges of n surfels. std::invalid_argument for another number of them.
ClusteredSurfels in_post_order(const Surfels& surfels, std::span<const Merge> merges);

/// Fills in the list of nodes that are no leaves.
void list_parents(SurfelTree& tree);

}  // namespace interreflect
