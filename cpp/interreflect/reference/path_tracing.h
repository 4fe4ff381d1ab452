/// Path tracing: what every other method is measured against.
///
/// Direct light is emission, the environment seen directly, and light reflected once; indirect light is everything reflected more
/// often. At every vertex a shadow ray goes to each point, spot and directional light and one each to a sampled emitter and to
/// the environment, weighed against the ray that the reflection chose [Veach 1997, 9.2].
#pragma once
#include <cstdint>
#include <optional>

#include "data/buffer.h"
#include "data/camera.h"
#include "data/counts.h"
#include "shading/lights.h"
#include "visibility/intersector.h"

namespace interreflect {

enum class PixelFilter { centre, box };

struct PathTracingSettings {
    int samples = 1;                          // paths a pixel; 0, through centres: only what is certain
    std::optional<double> milliseconds;       // instead: passes of one path until so much time has gone by; at least one
    std::optional<int> bounces = 1;           // most indirect bounces; 0: direct light only; none: all, by roulette
    PixelFilter pixel = PixelFilter::centre;  // centre: the G-buffer's point with its filtered texture; box: the pixel's mean
    int pattern = 8;  // in blocks of 4 n pixels, pixels at equal places of an n x n pattern share their random numbers
    std::uint32_t seed = 0;
};

struct PathTraced {
    int width = 0, height = 0, samples = 0;  // samples: paths that every pixel got
    Buffer<vec3> direct, indirect;           // radiance, W/(m^2 sr)
    Buffer<vec3> certain;  // through centres: the part of `direct` that has no noise, emission and delta lights; else empty
    Counts counts;
};

/// Throws std::invalid_argument where a setting, the camera or the size makes no picture.
PathTraced path_trace(const Scene& scene, const Intersector& intersector, const LightSampler& lights, const Camera& camera,
                      int width, int height, const PathTracingSettings& settings);

}  // namespace interreflect
