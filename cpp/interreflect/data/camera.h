/// A pinhole camera; pixel (0, 0) is the top left one.
#pragma once
#include "math/vectors.h"

namespace interreflect {

struct Camera {
    vec3 position{0, 0, 0}, target{0, 0, -1}, up{0, 1, 0};
    float fov_x = 60;  // horizontal field of view, degrees

    bool operator==(const Camera&) const = default;
};

/// The rays of one picture: direction(x, y) for continuous pixel coordinates (pixel centres at + 0.5), unit length.
struct CameraRays {
    vec3 origin, forward, right_step, down_step, corner;  // corner: direction through the top left corner, unnormalised
    int width, height;

    CameraRays(const Camera& camera, int w, int h) : origin(camera.position), width(w), height(h) {
        forward = glm::normalize(camera.target - camera.position);
        const vec3 right = glm::normalize(glm::cross(forward, camera.up));
        const vec3 down = glm::cross(forward, right);
        const float half = std::tan(0.5f * camera.fov_x * degrees_to_radians);
        const float pixel = 2.0f * half / static_cast<float>(w);
        right_step = right * pixel;
        down_step = down * pixel;
        corner = forward - right * half - down * (half * static_cast<float>(h) / static_cast<float>(w));
    }
    vec3 unnormalised(float x, float y) const { return corner + right_step * x + down_step * y; }
    vec3 direction(float x, float y) const { return glm::normalize(unnormalised(x, y)); }
    /// Angle that one pixel subtends at the centre of the picture, radians.
    float pixel_angle() const { return glm::length(right_step); }
};

}  // namespace interreflect
