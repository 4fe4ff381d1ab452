/// A triangle as seen from a point: its solid angle, and directions uniform in it.
#pragma once
#include "math/vectors.h"

namespace interreflect {

/// Solid angle of the triangle whose corners lie along the unit vectors a, b, c [van Oosterom and Strackee 1983].
inline float solid_angle(const vec3& a, const vec3& b, const vec3& c) {
    const float volume = std::fabs(glm::dot(a, glm::cross(b - a, c - a)));
    return 2.0f * std::atan2(volume, 1.0f + glm::dot(a, b) + glm::dot(b, c) + glm::dot(a, c));
}

/// A direction uniform in that solid angle [Arvo 1995]. Fit for solid angles from 1e-3 sr to less than 2 pi: below, the sum of
/// the angles loses its digits.
vec3 sample_spherical_triangle(const vec3& a, const vec3& b, const vec3& c, const vec2& u);

}  // namespace interreflect
