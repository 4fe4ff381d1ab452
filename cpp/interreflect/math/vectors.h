/// Vectors and matrices: GLM's types under the names the core uses.
#pragma once
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>

namespace interreflect {

using glm::ivec3;
using glm::mat3;
using glm::mat4;
using glm::mat4x3;
using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float degrees_to_radians = pi / 180.0f;

/// Relative luminance of linear Rec. 709 / sRGB primaries.
inline float luminance(const vec3& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
inline float max_component(const vec3& v) { return glm::max(v.x, glm::max(v.y, v.z)); }
inline float min_component(const vec3& v) { return glm::min(v.x, glm::min(v.y, v.z)); }

/// An orthonormal frame whose third axis is a unit normal [Duff et al. 2017, listing 3].
struct Frame {
    vec3 tangent, bitangent, normal;

    explicit Frame(const vec3& n) : normal(n) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        tangent = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        bitangent = {b, sign + n.y * n.y * a, -n.y};
    }
    vec3 to_world(const vec3& v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
    vec3 to_local(const vec3& v) const { return {glm::dot(v, tangent), glm::dot(v, bitangent), glm::dot(v, normal)}; }
};

}  // namespace interreflect
