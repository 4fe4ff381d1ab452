/// Where a body's own space stands in the world: rigid.
#pragma once
#include <cstdint>

#include "math/vectors.h"

namespace interreflect {

struct BodyPose {
    std::uint32_t body = 0;      // as instances number them; 0: the world itself, at the identity
    mat3 world_from_body{1.0f};  // a rotation
    vec3 origin{0};              // of the body's space, world space

    vec3 to_world(const vec3& p) const { return body == 0 ? p : world_from_body * p + origin; }
    vec3 direction_to_world(const vec3& d) const { return body == 0 ? d : world_from_body * d; }
    vec3 to_body(const vec3& p) const { return body == 0 ? p : (p - origin) * world_from_body; }
    vec3 direction_to_body(const vec3& d) const { return body == 0 ? d : d * world_from_body; }
};

}  // namespace interreflect
