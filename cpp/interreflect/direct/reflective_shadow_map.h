/// Reflective shadow maps: what a light sees, and how much of its flux every texel's surface sends on [Dachsbacher and Stamminger
/// 2005].
#pragma once
#include <span>
#include <vector>

#include "data/buffer.h"
#include "data/counts.h"
#include "data/scene.h"
#include "shading/lights.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Row by row. Where nothing is met, position, normal and fluxes are 0.
struct ReflectiveShadowMap {
    int size = 0;           // texels on a side
    Buffer<vec3> position;  // world space
    Buffer<vec3> normal;    // shading normal on the light's side, unit
    Buffer<vec3> incident;  // flux that arrives through the texel, W
    Buffer<vec3> flux;      // flux that the diffuse lobe sends on: albedo times incident, W
    Buffer<vec3> specular;  // reflectance of the glossy lobe at normal incidence
    Buffer<float> alpha;    // GGX width of the glossy lobe
    Buffer<float> area;     // of surface that the texel covers, scene units squared
    Buffer<float> offset;   // how far off the surface rays start (surface.h), scene units
    Counts counts;

    std::size_t texels() const { return static_cast<std::size_t>(size) * size; }
    std::size_t bytes() const { return texels() * (5 * sizeof(vec3) + 3 * sizeof(float)); }
};

/// `light`: number among the spot and directional lights as LightSampler counts. Spots must be narrower than 75 degrees (half
/// angle): std::invalid_argument otherwise, and for a point light.
ReflectiveShadowMap reflective_shadow_map(const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                                          int light, int size);

/// The maps of one disk of surface that sends light on as a diffuse surface does: every texel carries the same flux of it.
struct DiskView {
    vec3 position, normal;  // unit
    vec3 flux;              // W
    float offset;           // how far off the surface rays start
};
ReflectiveShadowMap reflective_shadow_map(const Scene& scene, const Intersector& intersector, const DiskView& disk, int size);

/// What all lights of a scene see. Every point, spot and directional light, all emitters together, and all of `environment`
/// together have size x size texels. A point light, and a spot too wide for one picture, sees all around, in texels of equal
/// solid angle; emitters are seen from `emitter_views` points on them, by luminance times area.
struct LightMapKnobs {
    int size = 512;
    int emitter_views = 16;
    std::span<const DirectionalLight> environment;  // that stand for the scene's environment
};
struct LightMaps {
    std::vector<ReflectiveShadowMap> maps;
    Counts counts;

    std::size_t texels() const;
    std::size_t bytes() const;
};
LightMaps light_maps(const Scene& scene, const Intersector& intersector, const LightSampler& lights, const LightMapKnobs& knobs);

}  // namespace interreflect
