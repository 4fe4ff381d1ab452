/// Voxels: where the surface is, what it looks like there, how it is lit, and the pyramid that cones march through.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "data/body_pose.h"
#include "data/buffer.h"
#include "data/counts.h"
#include "data/domain.h"
#include "data/texel_bricks.h"
#include "math/vectors.h"

namespace interreflect {

/// A point of a voxel's surface where the light of one of its sides is gathered: it lies on a triangle, so rays leave it as they
/// leave a hit.
struct VoxelPoint {
    vec3 position;           // world space
    float offset;            // rays start at position + offset * normal
    vec3 normal;             // unit geometric normal, on the side that is lit
    std::uint32_t reflects;  // 0: this side of the voxel reflects nothing
};

/// The voxels that the surface passes through, in ascending order of their cell, in parallel arrays.
///
/// Of a body, `domain` and cells lie in the body's own space and stay as they are while it moves; positions and normals are those
/// in the world at `pose`.
struct VoxelGrid {
    Domain domain;
    BodyPose pose;
    Buffer<std::uint32_t> cell;  // as Domain::cell numbers them
    Buffer<vec3> albedo;         // mean diffuse reflectance of the solid samples
    Buffer<vec3> normal;         // mean of the front sides' normals: unit, or (0, 0, 0) where they cancel
    Buffer<vec3> emission;       // mean radiance leaving the front side; apart from `albedo` and never marched by default
    Buffer<vec3> position;       // mean of the solid samples, world space
    Buffer<float> opacity;       // share of samples that are solid: 1 but for masks
    Buffer<float> area;          // of the solid surface inside, in faces of an unwarped voxel of the finest grid
    Buffer<VoxelPoint> points;   // where the front of voxel i is lit: points[i]
    Buffer<VoxelPoint> backs;    // and its back: the same surface's, or another one that faces away, as a slab's underside
    Counts counts;

    std::size_t size() const { return cell.size(); }
    std::size_t bytes() const {
        return size() * (sizeof(std::uint32_t) + 4 * sizeof(vec3) + 2 * sizeof(float) + 2 * sizeof(VoxelPoint));
    }
};

/// Reflected radiance (of direct light only, emission apart) of each voxel's surface, W/(m^2 sr).
struct LitVoxels {
    std::shared_ptr<const VoxelGrid> grid;
    Buffer<vec3> radiance;    // leaving the front
    Buffer<vec3> back;        // leaving the back; empty where it was not lit apart: it then passes for as bright as the front
    std::uint32_t frame = 0;  // how many frames before this one its history holds
    Counts counts;

    std::size_t bytes() const { return radiance.bytes() + back.bytes(); }
};

/// Radiance and opacity, halved in size from level to level down to one texel.
///
/// Level i has ceil(cells / 2^i) texels along each axis, down to 1 x 1 x 1; its texel (x, y, z) covers voxels
/// 2^i * [(x, y, z), (x, y, z) + 1] of the finest level (what lies beyond the domain there is air). Of n nested grids the first n
/// levels have as many texels as one grid has cells: level i is grid i, filled from level i - 1 where that lies inside it; the
/// levels after them halve in size as before. Texel (0, 0, 0) of level i stands where `origin` says, in its own texels.
///
/// A texel is four half floats R G B A, 8 bytes: A in [0, 1] is the opacity over the texel's own width, RGB the radiance
/// premultiplied by A and divided by `scale`. Every level has a border of one texel on all sides that repeats the nearest inner
/// one (a wall at the domain's edge stays as opaque as inside). So a trilinear tap at q texels (q = voxels / 2^i), with
/// b = floor(q - 0.5), reads the texels b and b + 1 without any clamping: four 16-byte loads of two neighbours in x, at
/// index(b), index(b + y), index(b + z) and index(b + y + z). Valid wherever -0.5 <= q < size + 0.5, so nothing must be clamped
/// inside the domain or within half a finest voxel of it. Of a body (see `pose`) the borders are air, as all around it is, and
/// single texels go on growing after the level that is one texel: cones wider than the body see it thinned out.
///
/// A level is dense, or it has bricks: only its texels that are not air are then kept, after one that is, in ascending order of
/// their place (x fastest), all volumes of one before the next one's, and the bricks say which is where.
///
/// `faces` of a level is the number of its volumes, one after the other where it is dense: 1; 6, for what is seen through the
/// texel's faces -x +x -y +y -z +z from outside; or 8, for what is seen along the octants of directions. Of six, an eye looking
/// along d reads face 0 where d.x > 0 and 1 where d.x < 0 (it looks at the side that faces it), and so on; it blends the three by
/// d * d. Of eight it reads number (d.x > 0) + 2 (d.y > 0) + 4 (d.z > 0); their opacities agree. The finest level has one or
/// eight. Four are radiance in two bands of spherical harmonics: it sees number 0 plus d.x, d.y and d.z times the others (whose A
/// is 0), at least 0.
struct Pyramid {
    struct Level {
        ivec3 size{0}, origin{0};
        int faces = 1;
        bool open = false;  // borders are air
        Buffer<std::uint16_t> texels;
        TexelBricks bricks{};

        bool dense() const { return bricks.count.x == 0; }
        std::size_t row() const { return static_cast<std::size_t>(size.x) + 2; }              // dense: texels from y to y + 1
        std::size_t slice() const { return row() * (static_cast<std::size_t>(size.y) + 2); }  // from z to z + 1
        std::size_t volume() const {
            return dense() ? slice() * (static_cast<std::size_t>(size.z) + 2) : 1;
        }  // from face to face
        /// Number of a texel, each coordinate in [-1, size]; its halves start at 4 times this.
        std::size_t index(int x, int y, int z, int face = 0) const {
            const std::size_t first = static_cast<std::size_t>(face) * volume();
            if (!dense()) return first + bricks.at(x, y, z);
            return first + static_cast<std::size_t>(z + 1) * slice() + static_cast<std::size_t>(y + 1) * row() +
                   static_cast<std::size_t>(x + 1);
        }
    };
    Domain domain;
    BodyPose pose;
    int faces = 1;       // of every level but the finest
    float scale = 1.0f;  // radiance = texel * scale: a power of two that keeps every radiance within half floats
    std::vector<Level> levels;
    std::shared_ptr<const LitVoxels> lit;  // what it was made from, both sides of every voxel; null: unknown
    Counts counts;

    std::size_t bytes() const {
        std::size_t sum = 0;
        for (const auto& level : levels) sum += level.texels.bytes() + level.bricks.bytes();
        return sum;
    }
};

/// The pyramids of a scene's parts: of what stands still and of bodies, in any order.
using Pyramids = std::span<const Pyramid* const>;

}  // namespace interreflect
