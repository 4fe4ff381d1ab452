/// Triangles that rasterization has no use for.
#pragma once
#include <array>
#include <span>

#include "voxels/voxelize/triangle_packet.h"

namespace interreflect {

/// The triangles that, seen along their dominant axis, hold no sample of any pixel: most of them where voxels are large. What is
/// too close to tell, or wider than a pixel, may be seen.
/// Pixels are `oversampling` to a voxel; at most eight samples.
class Unseen {
  public:
    Unseen(std::span<const vec2> samples, int oversampling);

    std::uint32_t of(const TrianglePacket& packet) const;

  private:
    std::array<vec2, 8> samples_;
    int count_;
    float scale_;
};

}  // namespace interreflect
