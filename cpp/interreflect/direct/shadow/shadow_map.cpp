#include "direct/shadow/shadow_map.h"

#include "direct/pixel_surface.h"
#include "direct/pixel_tiles.h"
#include "shading/brdf.h"
#include "visibility/depth_map.h"

namespace interreflect {
namespace {

void add_light(DirectLight& result, int number, const DepthMaps& maps, float bias, const Scene& scene, const LightSampler& lights,
               const GBuffer& g) {
    for_each_tile(g, [&](const TilePixels& pixels) {
        for (const std::size_t pixel : pixels) {
            const PixelSurface surface(g, scene, pixel);
            const SurfacePoint& point = surface.point;
            const LightSampler::Delta delta = lights.delta(number, point.position);
            if (max_component(delta.irradiance) <= 0.0f) continue;
            const vec3 f = evaluate_brdf(point, surface.to_viewer, delta.direction);
            if (max_component(f) <= 0.0f) continue;
            const float lit = maps.lit(point.position, point.geometric_normal, bias, point.offset);
            result.radiance[pixel] += f * delta.irradiance * (lit * glm::dot(point.normal, delta.direction));
        }
    });
}

}  // namespace

DirectLight shadow(const ShadowMap& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& g, std::uint32_t seed) {
    DirectLight result(g.width, g.height);
    parallel_blocks(g.pixels(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) result.radiance[pixel] = vec3(0);
    });
    if (scene.geometry->triangle_count() == 0) return result;
    for (int i = 0; i < lights.delta_count(); ++i) {
        const DepthMaps maps(views_of_light(scene, i, technique.size), intersector);
        add_light(result, i, maps, static_cast<float>(technique.bias), scene, lights, g);
        result.counts.rays += maps.texels();
    }
    add_emitters(result, technique.samples, scene, intersector, lights, g, seed);
    return result;
}

}  // namespace interreflect
