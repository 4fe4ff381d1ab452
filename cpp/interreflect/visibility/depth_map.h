/// Shadow maps: how far each light's rays reach, texel by texel, and whether a point lies within.
#pragma once
#include <vector>

#include "data/buffer.h"
#include "visibility/light_view.h"

namespace interreflect {

struct DepthMap {
    LightView view;
    Buffer<float> depth;  // distance along the texel's ray; infinite where nothing is met

    DepthMap(const LightView& light_view, const Intersector& intersector);

    /// Share, in [0, 1], of the 3 x 3 texels around a point's own that are lit at the point's tangent plane.
    /// Every texel is compared at the depth where its own ray meets that plane [Isidoro 2006, "receiver plane depth bias"]: flat
    /// receivers then agree with their map up to rounding however steeply they are lit, and `bias`, in texels, has to cover only
    /// the departure of the surface from its plane. `offset`: rounding of the receiver's position, scene units.
    float lit(const vec3& position, const vec3& geometric_normal, float bias, float offset) const;
};

/// The maps of one light: one, or the six sides of a cube.
struct DepthMaps {
    std::vector<DepthMap> maps;

    DepthMaps(const std::vector<LightView>& views, const Intersector& intersector);
    /// As DepthMap::lit, in the map that the point falls into; 1 where it falls into none.
    float lit(const vec3& position, const vec3& geometric_normal, float bias, float offset) const;
    std::size_t texels() const;
};

}  // namespace interreflect
