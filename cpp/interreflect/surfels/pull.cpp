#include "surfels/pull.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr std::size_t pieces = 64;

/// Nodes [begin, end).
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

/// What a subtree's surfels send. Apart from add_children: leaves and parents follow each other in no order that a processor
/// could guess, and neither loop has to.
void send(const SurfelTree& tree, std::span<const vec3> radiance, const NodeRange& subtree, NodeLight& light) {
    const std::size_t end = tree.leaf_end[subtree.end - 1], begin = end - tree.leaves[subtree.end - 1];
    for (std::size_t surfel = begin; surfel < end; ++surfel) {
        const std::uint32_t node = tree.node[surfel];
        light.value[node] = radiance[surfel] * (light.radiosity ? pi : pi * tree.area[node]);
    }
}

/// The sums of parents [begin, end) in the list, whose children are done.
void add_children(const SurfelTree& tree, std::size_t begin, std::size_t end, NodeLight& light) {
    vec3* const value = light.value.data();
    if (!light.radiosity) {
        for (std::size_t k = begin; k < end; ++k) {
            const std::uint32_t i = tree.parent[k];
            value[i] = value[tree.left(i)] + value[i - 1];
        }
        return;
    }
    for (std::size_t k = begin; k < end; ++k) {
        const std::uint32_t i = tree.parent[k], left = tree.left(i);
        value[i] = (value[left] * tree.area[left] + value[i - 1] * tree.area[i - 1]) / tree.area[i];
    }
}

/// How many parents lie before a node: of the nodes before it, those that are no leaves.
std::size_t parents_before(const SurfelTree& tree, std::size_t node) { return node == 0 ? 0 : node - tree.leaf_end[node - 1]; }

}  // namespace

NodeLight pull(const SurfelTree& tree, std::span<const vec3> radiance, bool as_radiosity) {
    const std::size_t n = tree.node.size();
    if (radiance.size() < n)
        throw std::invalid_argument("pull: light of " + std::to_string(radiance.size()) + " surfels for a tree of " +
                                    std::to_string(n));
    NodeLight light{Buffer<vec3>(tree.nodes()), as_radiosity, {}, 1.0f};
    const auto ranges = subtrees(tree);
    parallel_pieces(ranges.size(), [&](std::size_t piece) {
        const NodeRange& range = ranges[piece];
        send(tree, radiance, range, light);
        add_children(tree, parents_before(tree, range.begin), parents_before(tree, range.end), light);
    });
    // Ranges were found from the last one on; between them lie parents alone, which are summed in ascending order.
    std::size_t next = 0;
    for (std::size_t k = ranges.size(); k-- > 0; next = ranges[k].end)
        add_children(tree, parents_before(tree, next), parents_before(tree, ranges[k].begin), light);
    add_children(tree, parents_before(tree, next), parents_before(tree, tree.nodes()), light);
    return light;
}

NodeLight packed(NodeLight light) {
    if (light.is_packed() || light.value.empty()) return light;
    constexpr std::size_t together = 16384;
    const std::size_t n = light.value.size();
    std::vector<float> brightest((n + together - 1) / together, 0.0f);
    parallel_blocks(n, together, [&](std::size_t begin, std::size_t end) {
        float most = 0;
        for (std::size_t i = begin; i < end; ++i) most = std::max(most, max_component(light.value[i]));
        brightest[begin / together] = most;
    });
    const float most = *std::ranges::max_element(brightest);
    NodeLight made{{}, light.radiosity, Buffer<std::uint32_t>(n), 1.0f};
    if (most > 0) made.unit = std::ldexp(1.0f, std::max(std::ilogb(most) - 15, -126));  // below 2^16
    if (most > most_shared_exponent * made.unit) made.unit *= 2.0f;
    const float inverse = 1.0f / made.unit;
    parallel_blocks(n, together, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) made.packed[i] = to_shared_exponent(light.value[i] * inverse);
    });
    return made;
}

}  // namespace interreflect
