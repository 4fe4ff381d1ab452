/// The surface at a pixel, as the G-buffer kept it.
#pragma once
#include "data/gbuffer.h"
#include "data/scene.h"
#include "shading/pixel_lobe.h"
#include "visibility/surface.h"

namespace interreflect {

struct PixelSurface {
    SurfacePoint point;
    vec3 to_viewer;

    PixelSurface(const GBuffer& g, const Scene& scene, std::size_t pixel) {
        point.position = g.position[pixel];
        point.geometric_normal = g.geometric_normal[pixel];
        point.normal = g.normal[pixel];
        point.albedo = g.albedo[pixel];
        point.specular = g.specular[pixel];
        point.alpha = g.alpha[pixel];
        point.offset = g.offset[pixel];
        point.material = scene.material_of(g.triangle[pixel]);
        const PixelLobe lobe = lobe_at(g, scene.materials[point.material], pixel);
        point.exponent = lobe.exponent;
        point.lobe = lobe.lobe;
        to_viewer = g.seen_head_on ? point.normal : glm::normalize(g.camera.position - point.position);
    }
    bool reflects() const { return max_component(point.albedo) > 0.0f || glossy(); }
    bool glossy() const { return max_component(point.specular) > 0.0f; }
    vec3 ray_origin() const { return point.position + point.geometric_normal * point.offset; }
    /// A shadow ray to something `distance` away; it ends short of the surface of a light that lies there.
    Ray shadow_ray(const vec3& direction, float distance) const {
        return {ray_origin(), 0.0f, direction, distance * (1.0f - 0x1p-14f) - 2.0f * point.offset};
    }
};

}  // namespace interreflect
