/// A directional light at pixels, by its shadow map.
#pragma once
#include "data/gbuffer.h"
#include "shading/lights.h"
#include "visibility/depth_map.h"

namespace interreflect {

struct SunlitRun {
    static constexpr int length = 256;

    int count = 0;  // pixels
    // DepthMap::lit; 0 where a pixel faces away or nothing was hit, 1 where it lies beyond the map.
    alignas(64) float lit[length];
    vec3 diffuse[length];  // radiance that the diffuse lobe reflects, W/(m^2 sr)
};

/// Of pixels [first, first + run.count).
void light_by_sun(const LightSampler::Delta& sun, const DepthMap& map, float bias, const GBuffer& gbuffer, std::size_t first,
                  SunlitRun& run);

}  // namespace interreflect
