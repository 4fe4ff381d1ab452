/// The G-buffer: what the camera sees through every pixel's centre, in parallel arrays, row by row from the top.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>

#include "data/buffer.h"
#include "data/camera.h"
#include "data/counts.h"
#include "data/scene.h"
#include "math/vectors.h"

namespace interreflect {

inline constexpr std::uint32_t no_hit = std::numeric_limits<std::uint32_t>::max();

struct GBuffer {
    int width = 0, height = 0;
    Camera camera;
    Buffer<vec3> position;          // world space; undefined where nothing was hit
    Buffer<vec3> geometric_normal;  // unit, towards the camera; (0, 0, 0) where nothing was hit
    Buffer<vec3>
        normal;  // shading normal: unit, towards the camera, never below the geometric one's horizon as the camera sees it
    Buffer<vec3> albedo;             // diffuse reflectance, texture filtered by the pixel's footprint
    Buffer<vec3> specular;           // reflectance at normal incidence
    Buffer<vec3> emission;           // radiance towards the camera; the environment's where nothing was hit
    Buffer<float> alpha;             // GGX width
    Buffer<float> depth;             // distance along the ray; infinite where nothing was hit
    Buffer<float> offset;            // how far off the surface rays start (surface.h), scene units; 0 where nothing was hit
    Buffer<std::uint32_t> triangle;  // global number; no_hit
    Buffer<std::uint32_t> instance;  // no_hit where nothing was hit
    Buffer<std::uint32_t> body;      // 0 is "world"
    std::optional<Lobe> lobe;        // of every glossy surface; empty: each has its material's (stage shade)
    bool seen_head_on = false;       // every pixel along its own normal: surface points that no one camera sees
    Counts counts;

    std::size_t pixels() const { return static_cast<std::size_t>(width) * height; }
    bool hit(std::size_t pixel) const { return triangle[pixel] != no_hit; }
};

}  // namespace interreflect
