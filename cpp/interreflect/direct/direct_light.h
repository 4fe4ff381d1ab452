/// Direct light at the pixels of a G-buffer: what their surfaces reflect once, towards the camera.
#pragma once
#include "data/buffer.h"
#include "data/counts.h"
#include "math/vectors.h"

namespace interreflect {

struct DirectLight {
    int width = 0, height = 0;
    Buffer<vec3> radiance;  // W/(m^2 sr); 0 where nothing was hit
    Counts counts;

    DirectLight() = default;
    DirectLight(int w, int h) : width(w), height(h), radiance(static_cast<std::size_t>(w) * h) {}
};

}  // namespace interreflect
