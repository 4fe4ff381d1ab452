/// Look-ups of the environment's radiance; latitude-longitude images, bilinear, texel centres at (i + 0.5) / size.
#pragma once
#include "data/scene.h"

namespace interreflect {

/// Image coordinates in [0, 1]^2 of a unit direction in world space; (0, 0) is the top left corner, the centre lies at -z of the
/// light's own frame, +y is up, and u grows to the right seen from inside.
vec2 environment_coordinates(const Environment& environment, const vec3& direction);
/// The unit direction of image coordinates; inverse of environment_coordinates.
vec3 environment_direction(const Environment& environment, const vec2& coordinates);
/// Radiance that arrives from `direction` (unit, world space, away from the scene).
vec3 environment_radiance(const Environment& environment, const vec3& direction);

/// The same of a scene, which may have none.
inline vec3 environment_radiance(const Scene& scene, const vec3& direction) {
    return scene.environment ? environment_radiance(*scene.environment, direction) : vec3(0);
}

}  // namespace interreflect
