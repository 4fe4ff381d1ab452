/// Light gathered at the G-buffer's pixels, row by row from the top.
#pragma once
#include "data/buffer.h"
#include "data/counts.h"
#include "math/vectors.h"

namespace interreflect {

/// What arrives over the hemisphere about the shading normal; zero where nothing was hit.
struct GatheredLight {
    int width = 0, height = 0;
    Buffer<vec3> irradiance;  // of light that surfaces reflect, W/m^2
    Buffer<vec3> sky;         // irradiance of the environment through the openings, W/m^2
    Buffer<float> occlusion;  // cosine-weighted share of the hemisphere that is closed, in [0, 1]
    Counts counts;

    std::size_t bytes() const { return irradiance.bytes() + sky.bytes() + occlusion.bytes(); }
};

/// What the glossy lobe reflects towards the camera, W/(m^2 sr); zero where nothing was hit and where there is no lobe.
struct GlossyLight {
    int width = 0, height = 0;
    Buffer<vec3> radiance;  // of light that surfaces reflected before
    Buffer<vec3> sky;       // of the environment
    Counts counts;

    std::size_t bytes() const { return radiance.bytes() + sky.bytes(); }
};

}  // namespace interreflect
