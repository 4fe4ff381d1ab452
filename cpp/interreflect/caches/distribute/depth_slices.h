/// Depths in slices that are as deep as a multiple of a tile's width there [Olsson et al. 2012, 3.1, equation 2].
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

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

    /// The slice of a positive distance, not negative.
    std::uint32_t of(float distance) const {
        if (slices_an_octave_ == 0.0f) return 0;
        const float slice = std::floor(std::log2(distance * inverse_near_) * slices_an_octave_);
        return static_cast<std::uint32_t>(std::clamp(slice, -middle, middle) + middle);
    }

  private:
    static constexpr float middle = 1 << 20;
    float inverse_near_, slices_an_octave_;
};

}  // namespace interreflect
