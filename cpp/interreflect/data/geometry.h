/// Geometry: triangles in groups that are placed by instances; plain parallel arrays, integer handles.
///
/// Group 0 holds what never moves, in world space (it may be empty); every other group is one mesh that moves with a body, or is
/// placed several times, in its own space. A hit names an instance and a triangle; the triangle's number is global.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "data/buffer.h"
#include "math/vectors.h"

namespace interreflect {

/// What a caller hands in: borrowed arrays, checked by make_geometry.
struct MeshView {
    std::span<const vec3> positions;
    std::span<const uvec3> triangles;
    std::span<const vec3> normals;    // empty: flat
    std::span<const vec2> texcoords;  // empty: none
    std::uint32_t material = 0;
};
struct Placement {
    std::uint32_t mesh = 0;
    mat4 world_from_local{1.0f};
    std::uint32_t body = 0;  // 0 is "world", which does not move
};

/// Everything that is interpolated over a triangle, in half a cache line.
struct alignas(32) Vertex {
    vec3 position, normal;
    vec2 texcoord;
};

/// The arrays of all groups; shared by geometries that differ only in where their instances stand.
struct GeometryArrays {
    std::vector<vec3> positions;
    std::vector<vec3> normals;    // shading normals; (0, 0, 0): the triangle is flat there
    std::vector<vec2> texcoords;  // (0, 0) without texture coordinates
    std::vector<uvec3> triangles;
    std::vector<std::uint32_t> materials;  // one a triangle
    Buffer<Vertex> vertices;               // positions, normals and texcoords side by side, for those who interpolate them
};
struct Group {
    std::uint32_t first_triangle = 0, triangle_count = 0;
    std::uint32_t first_vertex = 0, vertex_count = 0;
};
/// lower > upper where there is nothing.
struct Bounds {
    vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

    void add(const vec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
    void add(const Bounds& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
};
struct Instance {
    std::uint32_t group = 0;
    std::uint32_t body = 0;
    mat4x3 world_from_local{1.0f};  // columns: three axes, origin
    mat3 normal_from_local{1.0f};   // inverse transpose
    bool identity = true;
    bool flips = false;  // mirrors: reverses the winding
    Bounds bounds{};     // world space
};

struct Geometry {
    std::shared_ptr<const GeometryArrays> arrays;
    std::vector<Group> groups;
    std::vector<Instance> instances;  // instance 0 places group 0, unmoved

    /// Triangles in all instances.
    std::uint64_t triangle_count() const;
    Bounds bounds() const;
};

/// Checks every array and index (std::invalid_argument names what is wrong), bakes what stands still into group 0, copies the
/// rest once.
std::shared_ptr<const Geometry> make_geometry(std::span<const MeshView> meshes, std::span<const Placement> placements);
/// The same arrays with every instance but the first where `placements` now has it (only their transforms are read), in the same
/// order.
std::shared_ptr<const Geometry> move_geometry(const Geometry& geometry, std::span<const Placement> placements);

/// The same arrays with the instances of one body alone, in the body's own space: body_from_world is rigid. Of body 0, what
/// belongs to no body. Not for ray hierarchies, which expect instance 0 to be what stands still.
std::shared_ptr<const Geometry> part_of_geometry(const Geometry& geometry, std::uint32_t body, const mat4& body_from_world);

/// The three corners of a triangle in world space.
struct Corners {
    vec3 a, b, c;
};
inline Corners world_corners(const Geometry& geometry, std::uint32_t instance, std::uint32_t triangle) {
    const auto& arrays = *geometry.arrays;
    const uvec3 t = arrays.triangles[triangle];
    const Corners local{arrays.positions[t.x], arrays.positions[t.y], arrays.positions[t.z]};
    const Instance& placed = geometry.instances[instance];
    if (placed.identity) return local;
    const mat4x3& m = placed.world_from_local;
    return {m * vec4(local.a, 1), m * vec4(local.b, 1), m * vec4(local.c, 1)};
}

}  // namespace interreflect
