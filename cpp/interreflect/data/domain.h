/// Where voxels stand: a box of them, evenly spread or warped, or several boxes nested in each other.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "data/warp.h"
#include "math/vectors.h"

namespace interreflect {

/// A point in a grid: the grid it falls into, and its place there in voxels (cells are the integer parts).
struct VoxelPlace {
    int cascade;
    vec3 voxels;
};

/// One grid: linear voxel (x, y, z) covers lower + voxel_size * [x, x + 1] x [y, y + 1] x [z, z + 1], world space; a warp moves
/// the voxels' faces. Or `cascades` nested grids of as many cells each, without a warp: grid k has voxels of 2^k voxel_size,
/// begins at `origin[k]` (in voxels of its own, from `lower`) and counts where no finer grid does: every point has one finest
/// voxel.
struct Domain {
    static constexpr int most_cascades = 8;

    vec3 lower{0};
    float voxel_size = 1.0f;  // of the finest grid, before it is warped
    ivec3 cells{1};           // of each grid
    Warp warp{};
    int cascades = 1;
    std::array<ivec3, most_cascades> origin{};

    /// Evenly spread voxels in one grid: linear and warped voxels are the same.
    bool plain() const { return warp.kind == Warp::Kind::linear && cascades == 1; }
    std::size_t cells_of_grid() const { return static_cast<std::size_t>(cells.x) * cells.y * cells.z; }
    std::size_t cell_count() const { return cells_of_grid() * static_cast<std::size_t>(cascades); }

    /// World space to linear voxels of the finest size, and back.
    vec3 to_linear(const vec3& position) const { return (position - lower) * (1.0f / voxel_size); }
    vec3 from_linear(const vec3& p) const { return lower + p * voxel_size; }

    /// Linear voxels to the finest grid that holds them (the outermost where none does).
    VoxelPlace place(const vec3& p) const;
    vec3 linear_of(const VoxelPlace& at) const;
    /// Linear voxels of one of nested grids to those of the finest size, and back.
    vec3 linear_in(int cascade, const vec3& voxels) const {
        return (voxels + vec3(origin[static_cast<std::size_t>(cascade)])) * static_cast<float>(1 << cascade);
    }
    vec3 in_cascade(int cascade, const vec3& p) const {
        return p * (1.0f / static_cast<float>(1 << cascade)) - vec3(origin[static_cast<std::size_t>(cascade)]);
    }

    /// World space to voxels: [0, cells] inside the domain, voxel centres at + 0.5. Of nested grids: in the finest one there.
    vec3 to_voxels(const vec3& position) const { return plain() ? to_linear(position) : place(to_linear(position)).voxels; }
    vec3 to_world(const VoxelPlace& at) const { return from_linear(linear_of(at)); }
    vec3 to_world(const vec3& voxels) const { return to_world(VoxelPlace{0, voxels}); }
    vec3 upper() const { return from_linear(vec3(cells) * static_cast<float>(1 << (cascades - 1))); }

    /// How many voxels lie along a unit of p, axis by axis: the Jacobian of the warp.
    mat3 density(const vec3& p) const;
    /// Number of the finest of nested grids at a point; towards the faces of a grid it grows steadily to the next one's.
    float grid_level(const vec3& p) const;
    /// Where that happens in grid k: from how far within its faces down (x + 1 / y to x), linear voxels of the finest size. A
    /// trilinear tap there has all of its texels within the grid.
    vec2 band(int k) const {
        const auto size = static_cast<float>(1 << k);
        return {size, 8.0f / (size * static_cast<float>(std::min({cells.x, cells.y, cells.z})))};
    }
    /// Radius of a view volume, linear voxels.
    float view_radius() const;
    /// The longest way of a cone, in voxels as small as there are.
    float longest_way() const;

    std::uint32_t cell(const ivec3& at, int cascade = 0) const {
        const auto one = static_cast<std::uint32_t>(at.x + cells.x * (at.y + cells.y * at.z));
        return one + static_cast<std::uint32_t>(static_cast<std::size_t>(cascade) * cells_of_grid());
    }
    int cascade_of(std::uint32_t cell) const {
        return cascades == 1 ? 0 : static_cast<int>(cell / static_cast<std::uint32_t>(cells_of_grid()));
    }
    ivec3 coordinates(std::uint32_t cell) const {
        if (cascades > 1) cell %= static_cast<std::uint32_t>(cells_of_grid());
        const auto row = static_cast<int>(cell / static_cast<std::uint32_t>(cells.x));
        return {static_cast<int>(cell % static_cast<std::uint32_t>(cells.x)), row % cells.y, row / cells.y};
    }
    bool inside(const vec3& voxels) const {
        const vec3 n(cells);
        return voxels.x >= 0.0f && voxels.y >= 0.0f && voxels.z >= 0.0f && voxels.x < n.x && voxels.y < n.y && voxels.z < n.z;
    }
    /// The cell of a point in world space; false outside.
    bool locate(const vec3& position, std::uint32_t& number) const {
        const VoxelPlace at = place(to_linear(position));
        if (!inside(at.voxels)) return false;
        number = cell(ivec3(at.voxels), at.cascade);
        return true;
    }
    /// Centre of a cell, linear voxels.
    vec3 linear_centre(std::uint32_t number) const { return linear_of({cascade_of(number), vec3(coordinates(number)) + 0.5f}); }
    /// A point, in linear voxels, from which positions in a cell are measured while they are summed up: its centre where that is
    /// known without inverting a warp.
    vec3 reference(std::uint32_t number) const {
        if (warp.view_volume()) return vec3(0);
        const vec3 centre = vec3(coordinates(number)) + 0.5f;
        return cascades > 1 ? linear_in(cascade_of(number), centre) : centre;
    }
    bool operator==(const Domain&) const = default;
};

}  // namespace interreflect
