#include "shading/spherical_triangle.h"

#include <algorithm>

namespace interreflect {
namespace {

/// Angle between unit vectors, accurate when small.
float angle_between(const vec3& a, const vec3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

vec3 orthogonal_part(const vec3& v, const vec3& unit) { return glm::normalize(v - unit * glm::dot(v, unit)); }

}  // namespace

vec3 sample_spherical_triangle(const vec3& a, const vec3& b, const vec3& c, const vec2& u) {
    const vec3 n_ab = glm::normalize(glm::cross(a, b)), n_bc = glm::normalize(glm::cross(b, c)),
               n_ca = glm::normalize(glm::cross(c, a));
    const float alpha = angle_between(n_ab, -n_ca), beta = angle_between(n_bc, -n_ab), gamma = angle_between(n_ca, -n_bc);
    const float area = u.x * (alpha + beta + gamma - pi);  // of the sub-triangle a, b, c'
    const float cos_alpha = std::cos(alpha), sin_alpha = std::sin(alpha);
    const float sin_phi = std::cos(area) * sin_alpha - std::sin(area) * cos_alpha;  // phi = area + pi - alpha
    const float cos_phi = -std::cos(area) * cos_alpha - std::sin(area) * sin_alpha;
    const float k1 = cos_phi + cos_alpha, k2 = sin_phi - sin_alpha * glm::dot(a, b);
    const float numerator = k2 + (cos_phi * k2 - sin_phi * k1) * cos_alpha;
    const float denominator = (sin_phi * k2 + cos_phi * k1) * sin_alpha;
    const float cos_b = std::clamp(denominator != 0.0f ? numerator / denominator : 1.0f, -1.0f, 1.0f);
    const float sin_b = std::sqrt(glm::max(0.0f, 1.0f - cos_b * cos_b));
    const vec3 c_sub = cos_b * a + sin_b * orthogonal_part(c, a);
    const float cos_theta = 1.0f - u.y * (1.0f - glm::dot(c_sub, b));
    const float sin_theta = std::sqrt(glm::max(0.0f, 1.0f - cos_theta * cos_theta));
    return glm::normalize(cos_theta * b + sin_theta * orthogonal_part(c_sub, b));
}

}  // namespace interreflect
