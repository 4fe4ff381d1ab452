/// The glossy lobe of a pixel's surface.
#pragma once
#include <algorithm>
#include <cmath>

#include "data/gbuffer.h"
#include "data/scene.h"
#include "visibility/surface.h"

namespace interreflect {

struct PixelLobe {
    Lobe lobe;
    float exponent;
};

/// Its material's, unless the G-buffer puts another in its place. Where the material has no exponent, that other lobe's is the
/// one that SCENE_FORMAT.md gives the same alpha.
inline PixelLobe lobe_at(const GBuffer& g, const Material& material, std::size_t pixel) {
    if (!g.lobe) return {material.lobe, material.exponent};
    if (material.exponent > 0.0f) return {*g.lobe, material.exponent};
    const float alpha = g.alpha[pixel];
    return {*g.lobe, std::max(2.0f / (alpha * alpha) - 2.0f, 0.0f)};
}

/// The surface of a pixel, for its lobe alone.
inline SurfacePoint glossy_surface(const GBuffer& g, const Scene& scene, std::size_t pixel) {
    SurfacePoint point;
    point.position = g.position[pixel];
    point.geometric_normal = g.geometric_normal[pixel];
    point.normal = g.normal[pixel];
    point.albedo = vec3(0);
    point.specular = g.specular[pixel];
    point.alpha = g.alpha[pixel];
    const PixelLobe lobe = lobe_at(g, scene.materials[scene.material_of(g.triangle[pixel])], pixel);
    point.exponent = lobe.exponent;
    point.lobe = lobe.lobe;
    return point;
}

}  // namespace interreflect
