/// Voxels: where the surface is, what it looks like there, how it is lit, and the pyramid that cones march through.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "data/buffer.h"
#include "data/counts.h"
#include "math/vectors.h"

namespace interreflect {

using glm::ivec3;

/// A box of cubic voxels: voxel (x, y, z) covers lower + voxel_size * [x, x + 1] x [y, y + 1] x [z, z + 1], world space.
struct Domain {
    vec3 lower{0};
    float voxel_size = 1.0f;
    ivec3 cells{1};

    std::size_t cell_count() const { return static_cast<std::size_t>(cells.x) * cells.y * cells.z; }
    /// World space to voxels: [0, cells] inside the domain, voxel centres at + 0.5.
    vec3 to_voxels(const vec3& position) const { return (position - lower) * (1.0f / voxel_size); }
    vec3 to_world(const vec3& voxels) const { return lower + voxels * voxel_size; }
    vec3 upper() const { return to_world(vec3(cells)); }
    std::uint32_t cell(const ivec3& at) const { return static_cast<std::uint32_t>(at.x + cells.x * (at.y + cells.y * at.z)); }
    ivec3 coordinates(std::uint32_t cell) const {
        const auto row = static_cast<int>(cell / static_cast<std::uint32_t>(cells.x));
        return {static_cast<int>(cell % static_cast<std::uint32_t>(cells.x)), row % cells.y, row / cells.y};
    }
    bool operator==(const Domain&) const = default;
};

/// A point of a voxel's surface where its light is gathered: it lies on a triangle, so rays leave it as they leave a hit.
struct VoxelPoint {
    vec3 position;       // world space
    float offset;        // rays start at position + offset * (geometric normal of the side they leave to)
    vec3 normal;         // unit geometric normal, on the front (winding) side
    std::uint32_t back;  // 1: the surface reflects on its back too
};

/// The voxels that the surface passes through, in ascending order of their cell, in parallel arrays.
struct VoxelGrid {
    Domain domain;
    Buffer<std::uint32_t> cell;  // x + cells.x (y + cells.y z)
    Buffer<vec3> albedo;         // mean diffuse reflectance of the solid samples
    Buffer<vec3> normal;         // mean of the front sides' normals: unit, or (0, 0, 0) where they cancel
    Buffer<vec3> emission;       // mean radiance leaving the front side; apart from `albedo` and never marched by default
    Buffer<vec3> position;       // mean of the solid samples, world space
    Buffer<float> opacity;       // share of samples that are solid: 1 but for masks
    Buffer<VoxelPoint> points;   // where voxel i is lit: points[i]
    Counts counts;

    std::size_t size() const { return cell.size(); }
    std::size_t bytes() const { return size() * (sizeof(std::uint32_t) + 4 * sizeof(vec3) + sizeof(float) + sizeof(VoxelPoint)); }
};

/// Reflected radiance (of direct light only, emission apart) of each voxel's surface, W/(m^2 sr).
struct LitVoxels {
    std::shared_ptr<const VoxelGrid> grid;
    Buffer<vec3> radiance;  // leaving the front
    Buffer<vec3> back;      // leaving the back; empty where it was not lit apart: it then passes for as bright as the front
    Counts counts;

    std::size_t bytes() const { return radiance.bytes() + back.bytes(); }
};

/// Radiance and opacity, halved in size from level to level down to one texel.
///
/// Level i has ceil(cells / 2^i) texels along each axis, down to 1 x 1 x 1; its texel (x, y, z) covers voxels
/// 2^i * [(x, y, z), (x, y, z) + 1] of the finest level (what lies beyond the domain there is air).
///
/// A texel is four half floats R G B A, 8 bytes: A in [0, 1] is the opacity over the texel's own width, RGB the radiance
/// premultiplied by A and divided by `scale`. Every level has a border of one texel on all sides that repeats the nearest inner
/// one (a wall at the domain's edge stays as opaque as inside). So a trilinear tap at q texels (q = voxels / 2^i), with
/// b = floor(q - 0.5), reads the texels b and b + 1 without any clamping: four 16-byte loads of two neighbours in x, at
/// index(b), index(b + y), index(b + z) and index(b + y + z). Valid wherever -0.5 <= q < size + 0.5, so nothing must be clamped
/// inside the domain or within half a finest voxel of it.
///
/// `faces` of a level is 1, or 6: volumes one after the other, for what is seen through the texel's faces -x +x -y +y -z +z from
/// outside. Light that travels to an eye looking along d is read from face 0 where d.x > 0 and 1 where d.x < 0 (the eye looks at
/// the side that faces it), and so on; blend the three by d * d. The finest level always has one.
struct Pyramid {
    struct Level {
        ivec3 size{0};
        int faces = 1;
        Buffer<std::uint16_t> texels;

        std::size_t row() const { return static_cast<std::size_t>(size.x) + 2; }                 // texels from y to y + 1
        std::size_t slice() const { return row() * (static_cast<std::size_t>(size.y) + 2); }     // from z to z + 1
        std::size_t volume() const { return slice() * (static_cast<std::size_t>(size.z) + 2); }  // from face to face
        /// Number of a texel, each coordinate in [-1, size]; its halves start at 4 times this.
        std::size_t index(int x, int y, int z, int face = 0) const {
            return static_cast<std::size_t>(face) * volume() + static_cast<std::size_t>(z + 1) * slice() +
                   static_cast<std::size_t>(y + 1) * row() + static_cast<std::size_t>(x + 1);
        }
    };
    Domain domain;
    int faces = 1;       // 1, or 6: of every level but the finest
    float scale = 1.0f;  // radiance = texel * scale: a power of two that keeps every radiance within half floats
    std::vector<Level> levels;
    std::shared_ptr<const LitVoxels> lit;  // what it was made from, both sides of every voxel; null: unknown
    Counts counts;

    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const auto& level : levels) sum += level.texels.bytes();
        return sum;
    }
};

}  // namespace interreflect
