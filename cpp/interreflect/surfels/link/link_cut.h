/// Which nodes of the tree a cache is linked to.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "data/surfels.h"

namespace interreflect {

/// Best first: the node with the largest visible solid angle is replaced by its children until there are as many as wanted; what
/// is invisible is left out [Jendersie et al. 2016, 4.5].
class LinkCut {
  public:
    explicit LinkCut(const SurfelTree& tree) : tree_(tree), solid_angle_(tree.nodes()) {}

    /// At most `most` nodes. solid_angle: of every surfel.
    std::span<const std::uint32_t> choose(std::span<const float> solid_angle, int most);
    /// Of a node, after `choose`.
    float solid_angle(std::uint32_t node) const { return solid_angle_[node]; }

  private:
    bool before(std::uint32_t a, std::uint32_t b) const {
        return solid_angle_[a] != solid_angle_[b] ? solid_angle_[a] < solid_angle_[b] : a < b;
    }
    const SurfelTree& tree_;
    std::vector<float> solid_angle_;
    std::vector<std::uint32_t> open_, chosen_;  // heap of nodes that have children; leaves
};

}  // namespace interreflect
