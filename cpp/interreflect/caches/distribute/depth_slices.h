/// Depths in slices that are as deep as a multiple of a tile's width there [Olsson et al. 2012, 3.1, equation 2].
#pragma once
#include <cmath>
#include <cstdint>

#include "caches/distribute/tile_kernels.h"
#include "data/scene.h"

namespace interreflect {

/// The longest side of the box about a scene; 1 where it is empty.
inline float scene_extent(const Scene& scene) {
    const auto bounds = scene.geometry->bounds();
    const float extent = max_component(bounds.upper - bounds.lower);
    return extent > 0.0f ? extent : 1.0f;
}

class DepthSlices {
  public:
    /// near: any length that scales with the scene, so that slices do too; angle: of a tile, radians; depth: in widths of a tile,
    /// 0: one slice of everything.
    DepthSlices(float near, float angle, double depth)
        : inverse_near_(near > 0.0f ? 1.0f / near : 1.0f),
          slices_an_octave_(depth > 0.0 ? static_cast<float>(1.0 / std::log2(1.0 + depth * angle)) : 0.0f) {}

    /// The slices of positive distances; no_cache where one is infinite.
    void of(const float* distance, std::size_t count, std::uint32_t* slice) const {
        slice_depths(distance, count, inverse_near_, slices_an_octave_, slice);
    }

  private:
    float inverse_near_, slices_an_octave_;
};

}  // namespace interreflect
