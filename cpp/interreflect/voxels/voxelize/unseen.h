/// Triangles that rasterization has no use for.
#pragma once
#include <array>
#include <span>

#include "voxels/voxelize/triangle_packet.h"

namespace interreflect {

/// The triangles whose box, seen along their dominant axis, holds no sample of any pixel: most of them where voxels are large.
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
