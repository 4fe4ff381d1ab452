/// Cluster surfels: which surfels send light on as one?
///
///   ClusteredSurfels cluster_surfels(const Technique&, const Surfels&);
///
/// A binary tree, whose nodes are patches of ever more surfels; the surfels come back in the order of its leaves. No exact
/// counterpart: AllSurfels (link) does without a tree.
#pragma once
#include <variant>

#include "surfels/cluster/agglomerative.h"
#include "surfels/cluster/kd_tree.h"

namespace interreflect {
using ClusterSurfels = std::variant<Agglomerative, KdTree>;
}
