#include "surfels/cluster/post_order.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace interreflect {
namespace {

void copy_surfel(const Surfels& from, std::size_t i, Surfels& to, std::size_t k) {
    to.position[k] = from.position[i], to.normal[k] = from.normal[i], to.area[k] = from.area[i];
    to.triangle[k] = from.triangle[i], to.barycentric[k] = from.barycentric[i];
}

}  // namespace

ClusteredSurfels in_post_order(const Surfels& surfels, std::span<const Merge> merges) {
    const std::size_t n = surfels.size(), nodes = n == 0 ? 0 : 2 * n - 1;
    if (merges.size() + 1 != std::max<std::size_t>(n, 1)) throw std::invalid_argument("a tree of n surfels has n - 1 merges");
    ClusteredSurfels made{
        make_surfels(n),
        {Buffer<std::uint32_t>(nodes), Buffer<std::uint32_t>(nodes), Buffer<std::uint32_t>(n), Buffer<float>(nodes), {}}};
    made.surfels.extent = surfels.extent;
    SurfelTree& tree = made.tree;
    // Children before their parent, left before right: a node is put down when it is met the second time.
    struct Visit {
        std::uint32_t merged;
        bool below;
    };
    std::vector<Visit> open;
    if (n > 0) open.push_back({static_cast<std::uint32_t>(nodes - 1), false});
    std::uint32_t next = 0, leaves = 0;
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        if (visit.merged < n) {
            copy_surfel(surfels, visit.merged, made.surfels, leaves);
            tree.node[leaves++] = next;
            tree.leaves[next] = 1, tree.area[next] = surfels.area[visit.merged], tree.leaf_end[next++] = leaves;
        } else if (!visit.below) {
            const Merge merge = merges[visit.merged - n];
            open.push_back({visit.merged, true});
            open.push_back({merge.right, false});
            open.push_back({merge.left, false});
        } else {
            const std::uint32_t right = next - 1, left = next - 2 * tree.leaves[right];
            tree.leaves[next] = tree.leaves[left] + tree.leaves[right];
            tree.area[next] = tree.area[left] + tree.area[right];
            tree.leaf_end[next++] = leaves;
        }
    }
    list_parents(tree);
    return made;
}

void list_parents(SurfelTree& tree) {
    tree.parent = Buffer<std::uint32_t>(tree.nodes() / 2);
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < tree.nodes(); ++i)
        if (tree.leaves[i] > 1) tree.parent[next++] = i;
}

}  // namespace interreflect
