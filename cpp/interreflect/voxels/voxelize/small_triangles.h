/// Tessellated triangles that are not cut: sixteen at a time.
#pragma once
#include <vector>

#include "data/scene.h"
#include "voxels/voxelize/contribution_sink.h"
#include "voxels/voxelize/triangle_packet.h"

namespace interreflect {

/// A material whose triangles vectors may look at: solid, dark, and of one colour or with an sRGB texture.
struct PlainLook {
    bool plain = false;
    std::uint32_t two_sided = 0;
    vec3 albedo{0};
    const std::uint32_t* srgb = nullptr;   // null: of one colour
    const std::int32_t* levels = nullptr;  // width, height and first texel of each
    int last_level = 0;
};

/// The triangles of a packet that tessellation does not cut, with what vectors need to know of them.
struct SmallTriangles {
    std::uint32_t in_one_cell = 0, uncut = 0;  // apart from each other
    float spacing;
};

/// What the samples of a packet are worth: number k is the centroid of triangle k, number 16 (i + 1) + k its corner i.
struct SmallTriangleSums {
    alignas(64) TrianglePacket::Lanes normal[3];
    SampleSums sums;
};

/// Puts into a sink what triangles in one cell, or with no edge longer than the spacing, give: a sample each, or their corners.
class SmallTriangleEmitter {
  public:
    SmallTriangleEmitter(const Scene& scene, const Domain& domain, float spacing);

    /// Returns the triangles it has dealt with.
    std::uint32_t operator()(const TrianglePacket& packet, std::uint32_t lanes, ContributionSink& sink) const;

  private:
    void emit(const TrianglePacket& packet, const SmallTriangles& small, const PlainLook& look, ContributionSink& sink) const;

    const Scene& scene_;
    ivec3 cells_;
    float spacing_;
    std::vector<PlainLook> looks_;  // of the scene's materials
};

}  // namespace interreflect
