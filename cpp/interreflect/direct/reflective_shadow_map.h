/// Reflective shadow maps: what a light sees, and how much of its flux every texel's surface sends on [Dachsbacher and Stamminger
/// 2005].
#pragma once
#include "data/buffer.h"
#include "data/counts.h"
#include "data/scene.h"
#include "shading/lights.h"
#include "visibility/intersector.h"
#include "visibility/light_view.h"

namespace interreflect {

struct ReflectiveShadowMap {
    LightView view;
    Buffer<vec3> position;  // world space; (0, 0, 0) where nothing is met
    Buffer<vec3> normal;    // shading normal on the light's side, unit; (0, 0, 0) where nothing is met
    Buffer<vec3> incident;  // flux that arrives through the texel, W
    Buffer<vec3> flux;      // flux that the diffuse lobe sends on: albedo times incident, W
    Buffer<vec3> specular;  // reflectance of the glossy lobe at normal incidence
    Buffer<float> alpha;    // GGX width of the glossy lobe
    Counts counts;
};

/// `light`: number among the spot and directional lights as LightSampler counts. Spots must be narrower than 75 degrees (half
/// angle): std::invalid_argument otherwise, and for a point light.
ReflectiveShadowMap reflective_shadow_map(const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                                          int light, int size);

}  // namespace interreflect
