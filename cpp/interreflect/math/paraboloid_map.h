/// The hemisphere about +z as a disk in the unit square, by a paraboloid [Brabec, Annen and Seidel 2002]: circles stay circles,
/// and no texel's solid angle is more than four times another's.
#pragma once
#include "math/vectors.h"

namespace interreflect {

/// A unit direction with z >= 0; the disk's rim is the horizon.
inline vec2 paraboloid_square(const vec3& direction) {
    return vec2(direction.x, direction.y) * (0.5f / (1.0f + direction.z)) + 0.5f;
}

/// The inverse. Corners of the square, outside the disk, are directions below the horizon.
inline vec3 paraboloid_direction(const vec2& square) {
    const vec2 p = square * 2.0f - 1.0f;
    const float r2 = glm::dot(p, p), scale = 1.0f / (1.0f + r2);
    return {p.x * 2.0f * scale, p.y * 2.0f * scale, (1.0f - r2) * scale};
}

}  // namespace interreflect
