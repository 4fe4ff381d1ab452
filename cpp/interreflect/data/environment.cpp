#include "data/environment.h"

#include <algorithm>

namespace interreflect {

vec2 environment_coordinates(const Environment& environment, const vec3& direction) {
    const vec3 d = glm::transpose(environment.world_from_light) * direction;
    const float u = 0.5f + std::atan2(d.x, -d.z) / (2.0f * pi);
    const float v = std::acos(std::clamp(d.y, -1.0f, 1.0f)) / pi;
    return {std::clamp(u, 0.0f, 1.0f), std::clamp(v, 0.0f, 1.0f)};
}

vec3 environment_direction(const Environment& environment, const vec2& coordinates) {
    const float phi = (coordinates.x - 0.5f) * 2.0f * pi, theta = coordinates.y * pi;
    const float s = std::sin(theta);
    return environment.world_from_light * vec3(s * std::sin(phi), std::cos(theta), -s * std::cos(phi));
}

vec3 environment_radiance(const Environment& environment, const vec3& direction) {
    if (environment.width == 0) return environment.radiance;
    const int width = environment.width, height = environment.height;
    const vec2 at = environment_coordinates(environment, direction);
    const float x = at.x * static_cast<float>(width) - 0.5f, y = at.y * static_cast<float>(height) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    // Around the circle the picture repeats; beyond a pole it goes on as its last row.
    const int x0 = (static_cast<int>(fx) + width) % width, x1 = (static_cast<int>(fx) + 1 + width) % width;
    const int y0 = std::clamp(static_cast<int>(fy), 0, height - 1), y1 = std::clamp(static_cast<int>(fy) + 1, 0, height - 1);
    const auto texel = [&](int i, int j) { return environment.image[static_cast<std::size_t>(j) * width + i]; };
    const vec3 upper = glm::mix(texel(x0, y0), texel(x1, y0), x - fx);
    const vec3 lower = glm::mix(texel(x0, y1), texel(x1, y1), x - fx);
    return environment.radiance * glm::mix(upper, lower, y - fy);
}

}  // namespace interreflect
