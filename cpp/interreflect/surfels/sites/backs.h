/// Telling places inside of solids, or behind walls, from those in the open.
#pragma once
#include "data/scene.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Of 64 directions spread evenly over the sphere, or those of them in the hemisphere about `normal` where that is not (0, 0, 0).
struct Sight {
    int seen = 0, backs = 0;  // surfaces, and those of them that show their back

    float share_of_backs() const { return seen > 0 ? static_cast<float>(backs) / static_cast<float>(seen) : 0.0f; }
};
Sight look_about(const vec3& position, const vec3& normal, const Scene& scene, const Intersector& intersector);

}  // namespace interreflect
