/// The hemisphere about +z as a square: equal in area and without seams.
///
/// Shirley and Chiu's concentric map [1997] takes the unit square to the unit disk, and Lambert's azimuthal equal-area projection
/// takes the disk to the hemisphere: the disk's centre is +z, its rim the horizon. Equal areas of the square are equal solid
/// angles; the map and its inverse are continuous, so texels that are neighbours on the hemisphere are neighbours in the square,
/// and nothing wraps. A map of n x n texels covers 2 pi / n^2 sr with each.
#pragma once
#include <algorithm>

#include "math/sampling.h"

namespace interreflect {

/// Unit square to unit direction, z in [0, 1]. z = 1 - r^2 of the disk's radius r: a cap's solid angle is 2 pi (1 - z).
inline vec3 hemisphere_direction(const vec2& square) {
    const vec2 disk = concentric_disk(square);
    const float r2 = glm::min(glm::dot(disk, disk), 1.0f), stretch = std::sqrt(2.0f - r2);
    return {disk.x * stretch, disk.y * stretch, 1.0f - r2};
}

/// The inverse; a direction below the horizon goes to the point of the rim above it, -z to a corner.
inline vec2 hemisphere_square(const vec3& direction) {
    const float along = std::hypot(direction.x, direction.y);
    if (along == 0.0f) return direction.z >= 0.0f ? vec2(0.5f) : vec2(1.0f);
    const float radius = std::sqrt(glm::clamp(1.0f - direction.z, 0.0f, 1.0f));
    const float x = std::fabs(direction.x), y = std::fabs(direction.y);
    // In the octant next to the x axis the square's x is the radius, and its y grows with the angle from 0 to the radius at 45
    // degrees.
    const float turn = std::atan2(glm::min(x, y), glm::max(x, y)) * (4.0f / pi) * radius;
    const vec2 p = x >= y ? vec2(radius, turn) : vec2(turn, radius);
    return vec2(std::copysign(p.x, direction.x), std::copysign(p.y, direction.y)) * 0.5f + 0.5f;
}

/// Centre of texel (x, y) of a map with `resolution` texels on a side.
inline vec2 map_texel_centre(int x, int y, int resolution) {
    return (vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / static_cast<float>(resolution);
}

/// Solid angle of each texel, sr.
inline float map_texel_solid_angle(int resolution) {
    return 2.0f * pi / (static_cast<float>(resolution) * static_cast<float>(resolution));
}

}  // namespace interreflect
