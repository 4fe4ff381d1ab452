/// Light sampling: where does light come from, seen from a point, and with which density was that direction chosen?
#pragma once
#include <cstdint>
#include <vector>

#include "data/scene.h"
#include "shading/emitters.h"
#include "shading/environment.h"
#include "visibility/intersector.h"

namespace interreflect {

/// A direction towards a light that has an extent.
struct LightDirection {
    vec3 direction{0};
    float distance = 0;  // infinite for the environment
    vec3 radiance{0};
    float pdf = 0;  // solid angle density, 1/sr; 0: no light
};

/// The lights of one scene; built once, queries are const and thread safe. The scene must outlive it.
class LightSampler {
  public:
    explicit LightSampler(const Scene& scene);

    /// A point, spot or directional light as seen from a point.
    struct Delta {
        vec3 direction{0};   // unit, towards the light
        float distance = 0;  // infinite for a directional light
        vec3 irradiance{0};  // on a surface that faces the light, W/m^2; 0 outside a spot's cone
    };
    using Area = LightDirection;

    /// Point, spot and directional lights, in that order.
    int delta_count() const { return points_ + spots_ + directions_; }
    Delta delta(int i, const vec3& position) const;
    /// Of a point or spot light along `direction` (unit, away from the light), W/sr.
    vec3 intensity(int i, const vec3& direction) const {
        if (i < points_) return scene_->point_lights[i].intensity;
        const SpotLight& light = scene_->spot_lights[i - points_];
        return light.intensity * cones_[i - points_].falloff(glm::dot(direction, light.direction));
    }
    /// Light that is the same at every position.
    bool delta_is_directional(int i) const { return i >= points_ + spots_; }

    bool has_emitters() const { return !emitters_.empty(); }
    /// Few emitters: in proportion to luminance times solid angle, and uniform in the solid angle of the chosen one. Many: in
    /// proportion to luminance times area, emission maps included, and uniform in area. `choose` and `u` are uniform in [0, 1).
    /// Many emitters sampled by area: near one of them the weight has no bound, unless a reflection's ray shares the work.
    bool emitters_are_many() const { return emitters_.many(); }
    Area sample_emitter(const vec3& position, float choose, const vec2& u) const { return emitters_.sample(position, choose, u); }
    /// Density of sample_emitter from `position` for the emitter point that a ray along `direction` hit.
    float emitter_pdf(const Hit& hit, const vec3& position, const vec3& direction) const {
        return emitters_.pdf(hit, position, direction);
    }

    /// A point on an emitter; there must be one.
    EmitterSampler::Point sample_emitter_point(float choose, const vec2& u) const { return emitters_.sample_point(choose, u); }

    std::span<const EmitterShape> emitter_shapes() const { return emitters_.shapes(); }

    bool has_environment() const { return environment_.present(); }
    /// The same radiance from everywhere: a sampler that knows the receiver's normal does better than sample_environment.
    bool environment_is_constant() const { return environment_.constant(); }
    Area sample_environment(const vec2& u) const;
    /// Radiance that arrives from `direction` (unit, away from the receiver).
    vec3 environment(const vec3& direction) const { return environment_.radiance(direction); }
    float environment_pdf(const vec3& direction) const { return environment_.pdf(direction); }

  private:
    /// Cosines of a spot's half angles.
    struct Cone {
        float inner, outer;

        /// Smoothstep between them.
        float falloff(float cosine) const {
            if (cosine >= inner) return 1.0f;
            if (cosine <= outer) return 0.0f;
            const float t = (cosine - outer) / (inner - outer);
            return t * t * (3.0f - 2.0f * t);
        }
    };

    const Scene* scene_;
    std::vector<Cone> cones_;
    int points_, spots_, directions_;
    EmitterSampler emitters_;
    EnvironmentSampler environment_;
};

}  // namespace interreflect
