#include "surfels/stored.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "surfels/sites/light_map.h"

namespace interreflect {
namespace {

constexpr std::size_t most_lanes = 16;  // that vectors may read beyond the last cone
constexpr int most_side = 4096;         // texels of a map, or cells of a box

void need(bool sound, const std::string& what) {
    if (!sound) throw std::invalid_argument("stored " + what);
}

bool finite(const Buffer<vec3>& places) {
    return std::ranges::all_of(places,
                               [](const vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
}

bool below(const Buffer<std::uint32_t>& numbers, std::size_t end) {
    return std::ranges::all_of(numbers, [end](std::uint32_t i) { return i < end; });
}

bool caches_or_none(const Buffer<std::uint32_t>& numbers, std::size_t caches) {
    return std::ranges::all_of(numbers, [caches](std::uint32_t i) { return i < caches || i == no_cache; });
}

/// Of node i > 0 with more than one leaf: both children lie before it, and their leaves side by side make up its own.
bool is_parent(const SurfelTree& tree, std::uint32_t i) {
    const std::uint32_t right = tree.right(i), of_right = tree.leaves[right];
    if (2 * static_cast<std::uint64_t>(of_right) > i) return false;
    const std::uint32_t left = tree.left(i);
    return tree.leaves[left] + of_right == tree.leaves[i] && tree.leaf_end[right] == tree.leaf_end[i] &&
           tree.leaf_end[left] == tree.leaf_end[i] - of_right;
}

void check_tree(const SurfelTree& tree, std::size_t n) {
    const std::size_t nodes = n > 0 ? 2 * n - 1 : 0;
    need(tree.leaves.size() == nodes && tree.leaf_end.size() == nodes && tree.area.size() == nodes && tree.node.size() == n,
         "tree: " + std::to_string(n) + " surfels have " + std::to_string(nodes) + " nodes, got " +
             std::to_string(tree.leaves.size()));
    std::uint32_t leaf = 0;
    for (std::uint32_t i = 0; i < nodes; ++i) {
        const bool is_leaf = tree.leaves[i] == 1;
        const bool sound =
            is_leaf ? leaf < n && tree.leaf_end[i] == leaf + 1 && tree.node[leaf] == i : i > 1 && is_parent(tree, i);
        need(sound && std::isfinite(tree.area[i]), "tree: node " + std::to_string(i) + " is not the next in post-order");
        if (is_leaf) ++leaf;
    }
    need(leaf == n && (nodes == 0 || tree.leaves[nodes - 1] == n), "tree: its root does not hold all surfels");
}

void check_grid(const GridSites& grid) {
    bool sound = grid.levels >= 1 && grid.levels <= most_grid_levels && std::isfinite(grid.reach) && grid.reach >= 0.0f &&
                 std::isfinite(grid.normal_offset);
    for (int axis = 0; axis < 3; ++axis)
        sound = sound && grid.size[axis] >= 0 && grid.size[axis] <= most_side && (grid.size[axis] > 0) == (grid.size.x > 0);
    need(sound, "caches: a box of " + std::to_string(grid.size.x) + " x " + std::to_string(grid.size.y) + " x " +
                    std::to_string(grid.size.z) + " cells in " + std::to_string(grid.levels) + " levels");
    const std::size_t cells = grid.first_of(grid.levels);
    need(grid.cache.size() == cells && grid.nearest.size() == cells,
         "caches: a box of " + std::to_string(cells) + " cells with " + std::to_string(grid.cache.size()));
}

}  // namespace

void check_stored(const ClusteredSurfels& stored, const Scene& scene) {
    const Surfels& surfels = stored.surfels;
    const std::size_t n = surfels.size(), triangles = scene.geometry->groups.front().triangle_count;
    need(
        surfels.normal.size() == n && surfels.area.size() == n && surfels.triangle.size() == n && surfels.barycentric.size() == n,
        "surfels: arrays of different lengths");
    need(finite(surfels.position) && finite(surfels.normal) && std::isfinite(surfels.extent) &&
             std::ranges::all_of(surfels.area, [](float a) { return std::isfinite(a) && a >= 0.0f; }),
         "surfels: a place, normal or area is not finite");
    need(below(surfels.triangle, triangles),
         "surfels: one lies on a triangle that the still surface lacks; it has " + std::to_string(triangles));
    check_tree(stored.tree, n);
}

void complete(ClusteredSurfels& surfels, const Scene&) { list_parents(surfels.tree); }
void complete(CacheSites& sites, const Scene& scene) { lay_planes(sites.map, scene); }

void check_stored(const CacheSites& sites, const Scene& scene) {
    const std::size_t n = sites.size(), triangles = scene.geometry->groups.front().triangle_count;
    need(sites.normal.size() == n && sites.offset.size() == n, "caches: arrays of different lengths");
    need(finite(sites.position) && finite(sites.normal) &&
             std::ranges::all_of(sites.offset, [](float o) { return std::isfinite(o); }),
         "caches: a place, normal or offset is not finite");
    const LightMapSites& map = sites.map;
    const auto side = static_cast<std::size_t>(std::clamp(map.size, 0, most_side));
    need(map.size >= 0 && map.size <= most_side && map.cache.size() == side * side &&
             map.texcoord.size() == 3 * map.triangle.size() && (side > 0 || map.triangle.empty()),
         "caches: a light map of " + std::to_string(map.size) + " texels a side with " + std::to_string(map.cache.size()) +
             " texels and " + std::to_string(map.texcoord.size()) + " corners of " + std::to_string(map.triangle.size()) +
             " triangles");
    need(below(map.triangle, triangles),
         "caches: a chart of a triangle that the still surface lacks; it has " + std::to_string(triangles));
    need(std::ranges::all_of(
             map.texcoord,
             [&](const vec2& t) { return std::min(t.x, t.y) >= 0.0f && std::max(t.x, t.y) <= static_cast<float>(map.size); }),
         "caches: a texture coordinate beyond the light map");
    check_grid(sites.grid);
    const GridSites& grid = sites.grid;
    need(caches_or_none(map.cache, n) && caches_or_none(grid.cache, n) && caches_or_none(grid.nearest, n),
         "caches: a texel or cell names a cache that is not there");
}

void check_stored(const CacheLinks& links, const CacheSites& sites, const ClusteredSurfels& surfels) {
    need(links.caches == sites.size() && links.nodes == surfels.tree.nodes(),
         "links: of " + std::to_string(links.caches) + " caches and " + std::to_string(links.nodes) + " nodes, not " +
             std::to_string(sites.size()) + " and " + std::to_string(surfels.tree.nodes()));
    need(links.per_cache >= 0 && links.per_cache <= 65536 && links.bands >= 1 && links.bands <= most_bands,
         "links: links a cache or bands out of range");
    const bool cones = links.kind == CacheLinks::Kind::cones;
    const std::size_t count = links.caches * static_cast<std::size_t>(links.per_cache);
    const std::size_t each = coefficients_of(links.bands);
    need(links.per_cache == 0 || (cones ? links.cones.size() >= count + most_lanes
                                        : links.node.size() == count && links.coefficients.size() >= count * each + 64),
         "links: arrays of other lengths than " + std::to_string(count) + " links");
    need(std::isfinite(links.unit) && links.unit > 0.0f, "links: their unit is not a positive number");
    const bool inside = cones ? std::ranges::all_of(links.cones, [&](const ConeLink& l) { return l.node < links.nodes; })
                              : below(links.node, links.nodes);
    need(links.per_cache == 0 || inside, "links: one names a node that is not there");
}

void check_stored(const LinkCandidates& links, const CacheSites& sites, const ClusteredSurfels& surfels) {
    check_stored(links.nodes, sites, surfels);
    const auto each = static_cast<std::size_t>(links.nodes.per_cache);
    need(links.nodes.kind == CacheLinks::Kind::cones && links.child.size() == links.nodes.caches * each,
         "links: candidates that are no cones, or of which not each tells of its children");
    for (std::size_t i = 0; i < links.child.size(); ++i) {
        const std::size_t child = links.child[i];
        need(child == 0 || (child > i % each && child + 1 < each), "links: the children of a candidate do not come after it");
    }
}

}  // namespace interreflect
