#include "shading/lights.h"

#include <limits>

namespace interreflect {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

LightSampler::Delta towards(const vec3& light, const vec3& intensity, const vec3& position) {
    const vec3 to = light - position;
    const float distance = glm::length(to);
    if (!(distance > 0.0f)) return {};
    const float inverse = 1.0f / distance;  // its square may overflow where intensity / distance^2 does not
    return {to * inverse, distance, intensity * inverse * inverse};
}

}  // namespace

LightSampler::LightSampler(const Scene& scene)
    : scene_(&scene),
      points_(static_cast<int>(scene.point_lights.size())),
      spots_(static_cast<int>(scene.spot_lights.size())),
      directions_(static_cast<int>(scene.directional_lights.size())),
      emitters_(scene),
      environment_(scene.environment ? &*scene.environment : nullptr) {
    for (const SpotLight& light : scene.spot_lights)
        cones_.push_back({std::cos(light.inner * degrees_to_radians), std::cos(light.outer * degrees_to_radians)});
}

LightSampler::Delta LightSampler::delta(int i, const vec3& position) const {
    if (i < points_) return towards(scene_->point_lights[i].position, scene_->point_lights[i].intensity, position);
    if (i < points_ + spots_) {
        const SpotLight& light = scene_->spot_lights[i - points_];
        const Cone& cone = cones_[i - points_];
        Delta delta = towards(light.position, light.intensity, position);
        delta.irradiance *= cone.falloff(-glm::dot(delta.direction, light.direction));
        return delta;
    }
    const DirectionalLight& light = scene_->directional_lights[i - points_ - spots_];
    return {-light.direction, infinity, light.irradiance};
}

LightSampler::Area LightSampler::sample_environment(const vec2& u) const {
    Area area;
    if (!environment_.present()) return area;
    area.direction = environment_.sample(u);
    area.distance = infinity;
    area.radiance = environment_.radiance(area.direction);
    area.pdf = environment_.pdf(area.direction);
    return area;
}

}  // namespace interreflect
