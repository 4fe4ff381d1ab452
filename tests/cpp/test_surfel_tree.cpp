// Trees of surfels: in post-order whatever made them, and greedy merges as a table of all distances makes them.
#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "math/rng.h"
#include "math/sampling.h"
#include "surfels/cluster.h"
#include "surfels/cluster/patch.h"

namespace interreflect {
namespace {

float random(std::uint32_t i) { return unit_float(hash32(i)); }

vec3 direction(float x, float y) {
    const float z = 1 - 2 * x, r = std::sqrt(std::max(0.0f, 1 - z * z)), turn = 2 * pi * y;
    return {r * std::cos(turn), r * std::sin(turn), z};
}

/// In a cube of side 1, any normals, areas that differ; the triangle is the surfel's number.
Surfels cloud(std::uint32_t n, std::uint32_t seed) {
    Surfels s = make_surfels(n);
    s.extent = std::sqrt(3.0f);
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto at = [&](std::uint32_t k) { return random(hash32(seed) + 8 * i + k); };
        s.position[i] = {at(0), at(1), at(2)}, s.normal[i] = direction(at(3), at(4)), s.area[i] = 0.5f + at(5);
        s.triangle[i] = i, s.barycentric[i] = vec2(0);
    }
    return s;
}
/// A square lattice in z = 0 that faces up: distances and areas that are equal, bit for bit.
Surfels lattice(std::uint32_t side) {
    Surfels s = make_surfels(side * side);
    s.extent = static_cast<float>(side);
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        s.position[i] = {static_cast<float>(i % side), static_cast<float>(i / side), 0}, s.normal[i] = {0, 0, 1};
        s.area[i] = 1, s.triangle[i] = i, s.barycentric[i] = vec2(0);
    }
    return s;
}

using Members = std::set<std::uint32_t>;

/// The surfels under every node, by their triangles.
std::vector<Members> members(const ClusteredSurfels& c) {
    std::vector<Members> made;
    for (std::size_t i = 0; i < c.tree.nodes(); ++i) {
        const auto end = c.surfels.triangle.begin() + c.tree.leaf_end[i];
        made.emplace_back(end - c.tree.leaves[i], end);
    }
    return made;
}

/// Of all pairs the nearest, of equally near ones that whose numbers differ least, then the lowest; a table of all.
struct TableOfDistances {
    std::multiset<Members> made;
    std::uint64_t inversions = 0;

    TableOfDistances(const Surfels& s, const Agglomerative& technique) {
        const PatchMetric metric{static_cast<float>(technique.normal_weight), static_cast<float>(technique.balance_weight)};
        struct Node {
            Patch patch;
            Members members;
            float height;
        };
        std::map<std::uint32_t, Node> nodes;
        for (std::uint32_t i = 0; i < s.size(); ++i) nodes[i] = {patch_of(s, i), {s.triangle[i]}, 0};
        std::uint32_t next = static_cast<std::uint32_t>(s.size());
        while (nodes.size() > 1) {
            std::tuple<float, std::uint32_t, std::uint32_t> best{std::numeric_limits<float>::infinity(), 0,
                                                                 0};  // distance, gap, lower
            for (auto a = nodes.begin(); a != nodes.end(); ++a)
                for (auto b = std::next(a); b != nodes.end(); ++b)
                    best = std::min(best, {metric(a->second.patch, b->second.patch), b->first - a->first, a->first});
            const auto [height, gap, first] = best;
            const std::uint32_t second = first + gap;
            const Node a = nodes[first], b = nodes[second];
            nodes.erase(first), nodes.erase(second);
            Node both{merged(a.patch, b.patch), a.members, height};
            both.members.insert(b.members.begin(), b.members.end());
            inversions += height < std::max(a.height, b.height) ? 1 : 0;
            made.insert(both.members);
            nodes[next++] = both;
        }
    }
};

void expect_same_merges(const Surfels& surfels, const Agglomerative& technique) {
    const ClusteredSurfels made = cluster_surfels(technique, surfels);
    std::multiset<Members> merges;
    for (const Members& m : members(made))
        if (m.size() > 1) merges.insert(m);
    const TableOfDistances truth(surfels, technique);
    EXPECT_EQ(merges, truth.made);
    EXPECT_EQ(made.tree.inversions, truth.inversions);
}

TEST(SurfelTree, GreedyMergesAreThoseOfATableOfAllDistances) {
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        expect_same_merges(cloud(150 + 40 * seed, seed), {});
        expect_same_merges(cloud(200, seed + 10), {0.0, 0.0});
        expect_same_merges(cloud(200, seed + 20), {1.0, 1.0});
    }
}

TEST(SurfelTree, TiesAreBrokenByNumber) {
    for (const std::uint32_t side : {2u, 5u, 13u})
        for (const Agglomerative& technique : {Agglomerative{}, Agglomerative{0.0, 0.0}})
            expect_same_merges(lattice(side), technique);
    // Surfels at one place, some of them turned.
    Surfels same = lattice(10);
    for (std::uint32_t i = 0; i < 100; ++i) same.position[i] = vec3(3), same.normal[i] = {0, 0, i % 3 == 0 ? -1.0f : 1.0f};
    expect_same_merges(same, {});
    same.extent = 0;
    expect_same_merges(same, {});
}

TEST(SurfelTree, SurfelsThatAreEqualAreNoSlower) {
    // Were all to choose the same one, each merge would have all others look again: hours.
    Surfels same = make_surfels(50000);
    same.extent = 1;
    for (std::uint32_t i = 0; i < same.size(); ++i) {
        same.position[i] = vec3(0), same.normal[i] = {0, 0, 1}, same.area[i] = 1, same.triangle[i] = i;
        same.barycentric[i] = vec2(0);
    }
    const ClusteredSurfels made = cluster_surfels(Agglomerative{}, same);
    EXPECT_EQ(made.tree.leaves[made.tree.nodes() - 1], 50000u);
}

TEST(SurfelTree, SurfelsThatAreNotFiniteAreRefused) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Surfels place = cloud(50, 1), normal = cloud(50, 1), area = cloud(50, 1);
        place.position[20].y = normal.normal[20].y = area.area[20] = bad;
        EXPECT_THROW(cluster_surfels(Agglomerative{}, area), std::invalid_argument);
        EXPECT_THROW(cluster_surfels(Agglomerative{}, place), std::invalid_argument);
        EXPECT_THROW(cluster_surfels(Agglomerative{}, normal), std::invalid_argument);
    }
}

TEST(SurfelTree, TheDistanceIsThatOfThePaper) {
    Surfels s = make_surfels(2);
    s.extent = 10;
    s.position[0] = {1, 2, 3}, s.position[1] = {2, 4, 5}, s.normal[0] = {0, 0, 1}, s.normal[1] = {0, 0.6f, 0.8f};
    s.area[0] = 2, s.area[1] = 8;
    const PatchMetric metric{0.1f, 0.02f};
    // 9 / 100 + 0.1 (1 - 0.8) + 0.02 * 6 / 8, to float's rounding.
    EXPECT_NEAR(metric(patch_of(s, 0), patch_of(s, 1)), 0.125f, 1e-7f);
    const Patch both = merged(patch_of(s, 0), patch_of(s, 1));
    EXPECT_FLOAT_EQ(both.area, 10);
    EXPECT_NEAR(glm::length(both.position - vec3(0.18f, 0.36f, 0.46f)), 0, 1e-7f);
    EXPECT_NEAR(glm::length(both.normal - glm::normalize(vec3(0, 4.8f, 8.4f))), 0, 1e-7f);
}

void expect_whole(const ClusteredSurfels& c, const Surfels& from) {
    const SurfelTree& tree = c.tree;
    const std::size_t n = from.size();
    ASSERT_EQ(c.surfels.size(), n);
    ASSERT_EQ(tree.nodes(), n == 0 ? 0 : 2 * n - 1);
    EXPECT_EQ(c.surfels.extent, from.extent);
    std::vector<std::uint32_t> numbers(c.surfels.triangle.begin(), c.surfels.triangle.end());
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(c.surfels.position[i], from.position[numbers[i]]);
        EXPECT_EQ(c.surfels.normal[i], from.normal[numbers[i]]);
        EXPECT_EQ(c.surfels.area[i], from.area[numbers[i]]);
        EXPECT_EQ(tree.leaves[tree.node[i]], 1u);
        EXPECT_EQ(tree.leaf_end[tree.node[i]], i + 1);
    }
    std::sort(numbers.begin(), numbers.end());
    for (std::uint32_t i = 0; i < n; ++i) EXPECT_EQ(numbers[i], i);
    for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
        double area = 0;
        for (std::uint32_t k = tree.leaf_end[i] - tree.leaves[i]; k < tree.leaf_end[i]; ++k)
            area += static_cast<double>(c.surfels.area[k]);
        EXPECT_NEAR(tree.area[i], area, 1e-5 * area);  // rounding of at most n sums
        if (tree.leaves[i] == 1) continue;
        const std::uint32_t left = tree.left(i), right = tree.right(i);
        EXPECT_LT(left, right);
        EXPECT_EQ(tree.leaves[left] + tree.leaves[right], tree.leaves[i]);
        EXPECT_EQ(tree.leaf_end[right], tree.leaf_end[i]);
        EXPECT_EQ(tree.leaf_end[left], tree.leaf_end[i] - tree.leaves[right]);
    }
}

TEST(SurfelTree, EveryNodeKnowsItsSurfelsAndTheirArea) {
    for (const std::uint32_t n : {0u, 1u, 2u, 3u, 7u, 64u, 1000u}) {
        const Surfels surfels = cloud(n, n);
        expect_whole(cluster_surfels(Agglomerative{}, surfels), surfels);
        expect_whole(cluster_surfels(KdTree{}, surfels), surfels);
    }
}

/// Two sides of a wall a twentieth of its side thick; the back's triangles are odd.
Surfels wall(std::uint32_t side) {
    Surfels s = make_surfels(2 * side * side);
    for (std::uint32_t i = 0; i < s.size(); ++i) {
        const bool back = i % 2 == 1;
        s.position[i] = {random(3 * i), random(3 * i + 1), back ? -0.05f : 0.0f}, s.normal[i] = {0, 0, back ? -1.0f : 1.0f};
        s.area[i] = 1, s.triangle[i] = i, s.barycentric[i] = vec2(0);
    }
    s.extent = std::sqrt(2.0f);
    return s;
}
/// Nodes that hold surfels of both sides.
std::size_t mixed(const ClusteredSurfels& c) {
    std::size_t count = 0;
    for (const Members& m : members(c)) {
        const auto odd = std::count_if(m.begin(), m.end(), [](std::uint32_t i) { return i % 2 == 1; });
        count += odd > 0 && odd < static_cast<std::ptrdiff_t>(m.size()) ? 1 : 0;
    }
    return count;
}

TEST(SurfelTree, AWallsTwoSidesMeetLast) {
    const Surfels surfels = wall(20);
    // Opposite sides are 0.2 and more apart, patches of one side less until few are left.
    EXPECT_LE(mixed(cluster_surfels(Agglomerative{}, surfels)), 8u);
    EXPECT_GE(mixed(cluster_surfels(Agglomerative{0.0, 0.02}, surfels)), 100u);
    // Halves by number cut beside the edge between the sides, so some of them stay mixed for a while.
    EXPECT_LE(10 * mixed(cluster_surfels(KdTree{}, surfels)), mixed(cluster_surfels(KdTree{0.0}, surfels)));
}

TEST(SurfelTree, BalanceMakesItFlatter) {
    const Surfels surfels = cloud(4000, 5);
    const auto deepest = [](const SurfelTree& tree) {
        std::vector<int> depth(tree.nodes());
        int most = 0;
        for (std::uint32_t i = static_cast<std::uint32_t>(tree.nodes()); i-- > 0;) {
            most = std::max(most, depth[i]);
            if (tree.leaves[i] > 1) depth[tree.left(i)] = depth[tree.right(i)] = depth[i] + 1;
        }
        return most;
    };
    const int balanced = deepest(cluster_surfels(Agglomerative{}, surfels).tree);
    EXPECT_LT(balanced, deepest(cluster_surfels(Agglomerative{0.1, 0.0}, surfels).tree));
    EXPECT_EQ(deepest(cluster_surfels(KdTree{}, surfels).tree), 12);  // 4000 leaves in halves
}

TEST(SurfelTree, ThreadsDoNotChangeIt) {
    const Surfels surfels = cloud(5000, 9);
    const auto order = [&] {
        const ClusteredSurfels c = cluster_surfels(Agglomerative{}, surfels);
        return std::vector<std::uint32_t>(c.surfels.triangle.begin(), c.surfels.triangle.end());
    };
    const std::vector<std::uint32_t> all = order();
    oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(order(), all);
}

}  // namespace
}  // namespace interreflect
