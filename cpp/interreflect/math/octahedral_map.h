/// The sphere as a square: the octahedron's upper half (about +y) inside, its lower half folded outwards [Praun and Hoppe 2003].
#pragma once
#include "math/vectors.h"

namespace interreflect {

/// Unit direction to the unit square.
inline vec2 octahedral_square(const vec3& d) {
    const float sum = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
    vec2 p(d.x / sum, d.z / sum);
    if (d.y < 0.0f) p = {std::copysign(1.0f - std::fabs(p.y), p.x), std::copysign(1.0f - std::fabs(p.x), p.y)};
    return p * 0.5f + 0.5f;
}

/// The inverse.
inline vec3 octahedral_direction(const vec2& square) {
    const vec2 p = square * 2.0f - 1.0f;
    vec3 d(p.x, 1.0f - std::fabs(p.x) - std::fabs(p.y), p.y);
    if (d.y < 0.0f) {
        const float x = d.x;
        d.x = std::copysign(1.0f - std::fabs(d.z), d.x);
        d.z = std::copysign(1.0f - std::fabs(x), d.z);
    }
    return glm::normalize(d);
}

}  // namespace interreflect
