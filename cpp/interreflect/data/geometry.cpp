#include "data/geometry.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace interreflect {
namespace {

constexpr std::uint64_t most_indices = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void fail(std::size_t mesh, const std::string& what) {
    throw std::invalid_argument("meshes[" + std::to_string(mesh) + "]: " + what);
}

bool finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check_mesh(const MeshView& mesh, std::size_t number) {
    const auto vertices = mesh.positions.size();
    if (!mesh.normals.empty() && mesh.normals.size() != vertices) fail(number, "normals must be as many as positions");
    if (!mesh.texcoords.empty() && mesh.texcoords.size() != vertices) fail(number, "texcoords must be as many as positions");
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), finite)) fail(number, "positions must be finite");
    if (!std::all_of(mesh.normals.begin(), mesh.normals.end(), finite)) fail(number, "normals must be finite");
    for (const auto& t : mesh.texcoords)
        if (!std::isfinite(t.x) || !std::isfinite(t.y)) fail(number, "texcoords must be finite");
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const uvec3 t = mesh.triangles[i];
        if (std::max({t.x, t.y, t.z}) >= vertices)
            fail(number,
                 "triangles[" + std::to_string(i) + "] has an index beyond the " + std::to_string(vertices) + " positions");
    }
}

void check_placement(const Placement& placement, std::size_t number, std::size_t meshes) {
    if (placement.mesh >= meshes) throw std::invalid_argument("instances[" + std::to_string(number) + "] names no mesh");
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(placement.world_from_local[column][row]))
                throw std::invalid_argument("instances[" + std::to_string(number) + "].transform must be finite");
}

Instance make_instance(std::uint32_t group, const Placement& placement) {
    Instance instance;
    instance.group = group;
    instance.body = placement.body;
    const mat4& m = placement.world_from_local;
    instance.world_from_local = mat4x3(vec3(m[0]), vec3(m[1]), vec3(m[2]), vec3(m[3]));
    const mat3 linear(m);
    const float determinant = glm::determinant(linear);
    if (determinant == 0.0f) throw std::invalid_argument("a transform is singular");
    instance.normal_from_local = glm::transpose(glm::inverse(linear));
    instance.identity = m == mat4(1.0f);
    instance.flips = determinant < 0.0f;
    return instance;
}

/// Appends a mesh to the arrays, moved by `placement` where it is baked.
void append(GeometryArrays& arrays, const MeshView& mesh, const Placement* baked) {
    const auto first = static_cast<std::uint32_t>(arrays.positions.size());
    const bool moves = baked != nullptr && baked->world_from_local != mat4(1.0f);
    const Instance placed = moves ? make_instance(0, *baked) : Instance{};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        arrays.positions.push_back(moves ? placed.world_from_local * vec4(mesh.positions[i], 1) : mesh.positions[i]);
        vec3 normal = mesh.normals.empty() ? vec3(0) : mesh.normals[i];
        if (moves) normal = placed.normal_from_local * normal;
        const float length = glm::length(normal);
        arrays.normals.push_back(length > 0 ? normal / length : vec3(0));
        arrays.texcoords.push_back(mesh.texcoords.empty() ? vec2(0) : mesh.texcoords[i]);
    }
    for (uvec3 t : mesh.triangles) {
        if (placed.flips) std::swap(t.y, t.z);
        arrays.triangles.push_back(t + uvec3(first));
        arrays.materials.push_back(mesh.material);
    }
}

Bounds bounds_of(const GeometryArrays& arrays, const Group& group, const Instance& instance) {
    Bounds bounds;
    for (std::uint32_t i = 0; i < group.vertex_count; ++i) {
        const vec3& p = arrays.positions[group.first_vertex + i];
        bounds.add(instance.identity ? p : instance.world_from_local * vec4(p, 1));
    }
    return bounds;
}

/// An instance and the box about it.
Instance placed_instance(const GeometryArrays& arrays, const std::vector<Group>& groups, std::uint32_t group,
                         const Placement& placement) {
    Instance instance = make_instance(group, placement);
    instance.bounds = bounds_of(arrays, groups[group], instance);
    return instance;
}

}  // namespace

std::uint64_t Geometry::triangle_count() const {
    std::uint64_t count = 0;
    for (const auto& instance : instances) count += groups[instance.group].triangle_count;
    return count;
}

Bounds Geometry::bounds() const {
    Bounds bounds;
    for (const auto& instance : instances) bounds.add(instance.bounds);
    return bounds;
}

std::shared_ptr<const Geometry> make_geometry(std::span<const MeshView> meshes, std::span<const Placement> placements) {
    std::uint64_t indices = 0, vertices = 0;
    for (const auto& mesh : meshes) {
        indices += mesh.triangles.size() * std::uint64_t{3};
        vertices += mesh.positions.size();
    }
    if (indices > most_indices || vertices > most_indices)
        throw std::invalid_argument("meshes: more than 2^32 indices or vertices");
    for (std::size_t i = 0; i < meshes.size(); ++i) check_mesh(meshes[i], i);
    std::vector<std::size_t> uses(meshes.size());
    for (std::size_t i = 0; i < placements.size(); ++i) {
        check_placement(placements[i], i, meshes.size());
        ++uses[placements[i].mesh];
    }

    auto arrays = std::make_shared<GeometryArrays>();
    arrays->positions.reserve(vertices + 1);  // the ray library reads 16 bytes from the last position
    arrays->normals.reserve(vertices);
    arrays->texcoords.reserve(vertices);
    arrays->triangles.reserve(indices / 3);
    arrays->materials.reserve(indices / 3);
    auto geometry = std::make_shared<Geometry>();
    const auto close_group = [&](std::uint32_t first_triangle, std::uint32_t first_vertex) {
        geometry->groups.push_back({first_triangle, static_cast<std::uint32_t>(arrays->triangles.size()) - first_triangle,
                                    first_vertex, static_cast<std::uint32_t>(arrays->positions.size()) - first_vertex});
    };

    for (const auto& placement : placements)
        if (placement.body == 0 && uses[placement.mesh] == 1) append(*arrays, meshes[placement.mesh], &placement);
    close_group(0, 0);
    geometry->instances.push_back(Instance{});
    geometry->instances[0].bounds = bounds_of(*arrays, geometry->groups[0], geometry->instances[0]);

    std::map<std::uint32_t, std::uint32_t> group_of_mesh;
    for (const auto& placement : placements) {
        if (placement.body == 0 && uses[placement.mesh] == 1) continue;
        const auto [found, added] =
            group_of_mesh.try_emplace(placement.mesh, static_cast<std::uint32_t>(geometry->groups.size()));
        if (added) {
            const auto first_triangle = static_cast<std::uint32_t>(arrays->triangles.size());
            const auto first_vertex = static_cast<std::uint32_t>(arrays->positions.size());
            append(*arrays, meshes[placement.mesh], nullptr);
            close_group(first_triangle, first_vertex);
        }
        geometry->instances.push_back(placed_instance(*arrays, geometry->groups, found->second, placement));
    }
    arrays->vertices = Buffer<Vertex>(arrays->positions.size());
    for (std::size_t i = 0; i < arrays->vertices.size(); ++i)
        arrays->vertices[i] = {arrays->positions[i], arrays->normals[i], arrays->texcoords[i]};
    geometry->arrays = std::move(arrays);
    return geometry;
}

std::shared_ptr<const Geometry> move_geometry(const Geometry& geometry, std::span<const Placement> placements) {
    if (placements.size() + 1 != geometry.instances.size())
        throw std::invalid_argument("moved: as many transforms as moving instances expected");
    auto moved = std::make_shared<Geometry>(geometry);
    for (std::size_t i = 0; i < placements.size(); ++i) {
        Placement placement = placements[i];
        placement.mesh = 0;
        check_placement(placement, i, 1);
        placement.body = geometry.instances[i + 1].body;
        moved->instances[i + 1] = placed_instance(*geometry.arrays, geometry.groups, geometry.instances[i + 1].group, placement);
    }
    return moved;
}

std::shared_ptr<const Geometry> part_of_geometry(const Geometry& geometry, std::uint32_t body, const mat4& body_from_world) {
    auto part = std::make_shared<Geometry>();
    part->arrays = geometry.arrays;
    part->groups = geometry.groups;
    for (const Instance& instance : geometry.instances) {
        if (instance.body != body) continue;
        Placement placement;
        placement.body = body;
        placement.world_from_local = body_from_world * mat4(instance.world_from_local);
        part->instances.push_back(body == 0 ? instance : placed_instance(*part->arrays, part->groups, instance.group, placement));
    }
    return part;
}

}  // namespace interreflect
