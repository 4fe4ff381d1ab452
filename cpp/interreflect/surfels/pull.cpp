#include "surfels/pull.h"

#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr std::size_t pieces = 64;

struct NodeRange {
    std::size_t begin, end;
};

/// Subtrees of at most a `pieces`-th of all nodes: ranges that owe nothing to each other. The other nodes come after theirs.
std::vector<NodeRange> subtrees(const SurfelTree& tree) {
    std::vector<NodeRange> ranges;
    const std::size_t most = tree.nodes() / pieces + 1;
    for (std::size_t end = tree.nodes(); end > 0;) {
        const std::size_t size = 2 * static_cast<std::size_t>(tree.leaves[end - 1]) - 1;
        if (size <= most) {
            ranges.push_back({end - size, end});
            end -= size;
        } else {
            --end;
        }
    }
    return ranges;
}

}  // namespace

NodeLight pull(const SurfelTree& tree, std::span<const vec3> radiance, bool as_radiosity) {
    const std::size_t n = tree.node.size();
    if (radiance.size() < n)
        throw std::invalid_argument("pull: light of " + std::to_string(radiance.size()) + " surfels for a tree of " +
                                    std::to_string(n));
    NodeLight light{Buffer<vec3>(tree.nodes()), as_radiosity};
    vec3* value = light.value.data();
    const auto sum_up = [&](std::size_t i) {
        const std::uint32_t leaves = tree.leaves[i];
        if (leaves == 1) {
            const float scale = as_radiosity ? pi : pi * tree.area[i];
            value[i] = radiance[tree.leaf_end[i] - 1] * scale;
        } else {
            const std::uint32_t left = tree.left(static_cast<std::uint32_t>(i));
            value[i] = as_radiosity ? (value[left] * tree.area[left] + value[i - 1] * tree.area[i - 1]) / tree.area[i]
                                    : value[left] + value[i - 1];
        }
    };
    const auto ranges = subtrees(tree);
    parallel_pieces(ranges.size(), [&](std::size_t piece) {
        for (std::size_t i = ranges[piece].begin; i < ranges[piece].end; ++i) sum_up(i);
    });
    // Ranges were found from the last one on; what lies between them is summed in ascending order.
    std::size_t next = 0;
    for (std::size_t k = ranges.size(); k-- > 0;) {
        for (; next < ranges[k].begin; ++next) sum_up(next);
        next = ranges[k].end;
    }
    for (; next < tree.nodes(); ++next) sum_up(next);
    return light;
}

}  // namespace interreflect
