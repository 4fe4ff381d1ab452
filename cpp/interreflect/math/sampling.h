/// Maps from the unit square to directions, with their densities.
#pragma once
#include "math/vectors.h"

namespace interreflect {

/// Unit square to unit disk, concentric [Shirley and Chiu 1997].
inline vec2 concentric_disk(const vec2& u) {
    const float x = 2.0f * u.x - 1.0f, y = 2.0f * u.y - 1.0f;
    if (x == 0.0f && y == 0.0f) return {0.0f, 0.0f};
    float radius, angle;
    if (std::fabs(x) > std::fabs(y)) {
        radius = x;
        angle = pi / 4.0f * (y / x);
    } else {
        radius = y;
        angle = pi / 2.0f - pi / 4.0f * (x / y);
    }
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Cosine-distributed direction about +z; density cos / pi.
inline vec3 cosine_hemisphere(const vec2& u) {
    const vec2 d = concentric_disk(u);
    return {d.x, d.y, std::sqrt(glm::max(0.0f, 1.0f - d.x * d.x - d.y * d.y))};
}

/// Uniform direction on the sphere; density 1 / (4 pi).
inline vec3 uniform_sphere(const vec2& u) {
    const float z = 1.0f - 2.0f * u.x, r = std::sqrt(glm::max(0.0f, 1.0f - z * z)), phi = 2.0f * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Barycentric coordinates (of the second and third corner), uniform over a triangle.
inline vec2 uniform_triangle(const vec2& u) {
    const float s = std::sqrt(u.x);
    return {1.0f - s, u.y * s};
}

}  // namespace interreflect
