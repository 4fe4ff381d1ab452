/// The environment as cones see it: its mean radiance over a cone, by the cone's direction.
#pragma once
#include <vector>

#include "data/scene.h"

namespace interreflect {

class ConeEnvironment {
  public:
    /// Cones of `half_angle` (radians). An image is filtered once, over an octahedral map; a constant stays what it is.
    ConeEnvironment(const Scene& scene, float half_angle);

    bool present() const { return environment_ != nullptr; }
    /// The same radiance from everywhere (or none at all).
    bool constant() const { return map_.empty(); }
    /// Mean radiance over a cone about a unit direction, world space.
    vec3 mean(const vec3& direction) const;

  private:
    const Environment* environment_ = nullptr;
    vec3 constant_{0};
    std::vector<vec3> map_;  // map_size x map_size texels
};

}  // namespace interreflect
