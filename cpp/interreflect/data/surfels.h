/// Surfels: disks that stand for the scene's still surface, and the tree that sums up what they send on.
#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "data/buffer.h"
#include "data/counts.h"
#include "math/shared_exponent.h"
#include "math/vectors.h"

namespace interreflect {

/// In parallel arrays, in the order of the tree's leaves once there is one. Each lies on the side of its triangle that `normal`
/// points to.
struct Surfels {
    Buffer<vec3> position, normal;   // world space; unit, geometric
    Buffer<float> area;              // scene units squared; the fronts' sum up to the still surface's
    Buffer<std::uint32_t> triangle;  // global number; of the geometry's instance 0
    Buffer<vec2> barycentric;        // weights of the second and third corner
    float extent = 0;                // diagonal of the still surface's bounds, scene units

    std::size_t size() const { return position.size(); }
    std::size_t bytes() const { return size() * (2 * sizeof(vec3) + sizeof(vec2) + sizeof(float) + sizeof(std::uint32_t)); }
};
inline Surfels make_surfels(std::size_t n) {
    return {Buffer<vec3>(n), Buffer<vec3>(n), Buffer<float>(n), Buffer<std::uint32_t>(n), Buffer<vec2>(n), 0.0f};
}

/// A binary tree over n surfels; its 2n - 1 nodes lie in post-order, so a sum over children is one pass over memory. The right
/// child of node i is i - 1, the left one i - 2 leaves[i - 1]; the root is last. Leaves, from left to right, are the surfels.
struct SurfelTree {
    Buffer<std::uint32_t> leaves;  // under each node; 1: it is a leaf
    Buffer<std::uint32_t>
        leaf_end;                  // number of leaves up to and with the last under the node: its surfels are [end - leaves, end)
    Buffer<std::uint32_t> node;    // of each surfel
    Buffer<float> area;            // of each node's surfels, scene units squared
    Buffer<std::uint32_t> parent;  // the n - 1 nodes that are no leaves, in ascending order
    std::uint64_t inversions = 0;  // merges nearer than one of those that they build on

    std::size_t nodes() const { return leaves.size(); }
    std::uint32_t right(std::uint32_t i) const { return i - 1; }
    std::uint32_t left(std::uint32_t i) const { return i - 2 * leaves[i - 1]; }
    std::size_t bytes() const { return leaves.bytes() + leaf_end.bytes() + node.bytes() + area.bytes() + parent.bytes(); }
};

/// Of every node: flux, W; or radiosity, W/m^2, where that was pulled. As floats, or packed (math/shared_exponent.h).
struct NodeLight {
    Buffer<vec3> value;
    bool radiosity = false;
    Buffer<std::uint32_t> packed{};  // multiples of `unit`; then there are no floats
    float unit = 1.0f;

    bool is_packed() const { return !packed.empty(); }
    std::size_t size() const { return is_packed() ? packed.size() : value.size(); }
    vec3 at(std::size_t node) const { return is_packed() ? from_shared_exponent(packed[node]) * unit : value[node]; }
    std::size_t bytes() const { return value.bytes() + packed.bytes(); }
};

}  // namespace interreflect
