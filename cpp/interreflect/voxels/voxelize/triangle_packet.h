/// Sixteen triangles side by side: voxelizations are done with most triangles by a glance at them.
#pragma once
#include <cstdint>

#include "data/domain.h"
#include "data/geometry.h"

namespace interreflect {

/// Sets of triangles are bits, the first one's the lowest. Numbers of triangles that are not there mean nothing.
struct TrianglePacket {
    static constexpr int width = 16;
    using Lanes = float[width];

    alignas(64) Lanes corner[3][3];             // of each corner x, y and z, linear voxels
    alignas(64) Lanes cross[3];                 // of the edges that leave the first corner
    alignas(64) Lanes offset;                   // of rays that leave the triangle, world space
    alignas(64) std::int32_t vertex[3][width];  // numbers of the corners
    std::uint32_t first = 0;                    // the first triangle's number
    bool flips = false;                         // front sides face against `cross`
    std::uint32_t with_area = 0;                // the triangles that are there and have an area
    std::uint32_t outside = 0;                  // whose box misses [0, cells]
    std::uint32_t crossing = 0;                 // whose box reaches beyond it

    vec3 corner_of(int lane, int i) const { return {corner[i][0][lane], corner[i][1][lane], corner[i][2][lane]}; }
    vec3 cross_of(int lane) const { return {cross[0][lane], cross[1][lane], cross[2][lane]}; }
};

/// Where one instance's triangles are read.
struct PacketSource {
    const std::uint32_t* triangles;
    const float* positions;
    const mat4x3* placed;  // null where they stand in world space as they are
    vec3 lower, cells;
    float voxels;  // along a unit of world space
    bool flips;

    PacketSource(const Geometry& geometry, const Domain& domain, std::uint32_t instance);
};

/// Triangles [first, first + count), at most `width` of them.
void load_packet(const PacketSource& source, std::uint32_t first, std::uint32_t count, TrianglePacket& packet);

}  // namespace interreflect
