#include "direct/shadow/shadow_map.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "direct/pixel_surface.h"
#include "direct/pixel_tiles.h"
#include "direct/shadow/sun_lanes.h"
#include "shading/brdf.h"

namespace interreflect {
namespace {

constexpr std::size_t pixels_a_block = 1 << 12;

void add_positional_light(DirectLight& result, int number, const DepthMaps& maps, float bias, const Scene& scene,
                          const LightSampler& lights, const GBuffer& g) {
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

/// A directional light is the same at every pixel, and most surfaces are diffuse.
void add_directional_light(DirectLight& result, const LightSampler::Delta& sun, const DepthMap& map, float bias,
                           const Scene& scene, const GBuffer& g) {
    parallel_blocks(g.pixels(), pixels_a_block, [&](std::size_t begin, std::size_t end) {
        SunlitRun run;
        for (std::size_t first = begin; first < end; first += SunlitRun::length) {
            run.count = static_cast<int>(std::min<std::size_t>(SunlitRun::length, end - first));
            light_by_sun(sun, map, bias, g, first, run);
            for (int i = 0; i < run.count; ++i) {
                const std::size_t pixel = first + static_cast<std::size_t>(i);
                vec3 reflected = run.diffuse[i];
                if (run.lit[i] > 0.0f && max_component(g.specular[pixel]) > 0.0f) {
                    const PixelSurface surface(g, scene, pixel);
                    reflected = evaluate_brdf(surface.point, surface.to_viewer, sun.direction) * sun.irradiance *
                                (run.lit[i] * glm::dot(surface.point.normal, sun.direction));
                }
                result.radiance[pixel] += reflected;
            }
        }
    });
}

}  // namespace

std::size_t ShadowMaps::bytes() const {
    std::size_t sum = 0;
    for (const DepthMaps& light : lights) sum += light.texels() * sizeof(float);
    return sum;
}

ShadowMaps shadow_maps(const ShadowMap& technique, const Scene& scene, const Intersector& intersector) {
    ShadowMaps made;
    const auto lights = scene.point_lights.size() + scene.spot_lights.size() + scene.directional_lights.size();
    for (std::size_t i = 0; i < lights && scene.geometry->triangle_count() > 0; ++i) {
        made.lights.emplace_back(views_of_light(scene, static_cast<int>(i), technique.size), intersector);
        made.counts.rays += made.lights.back().texels();
    }
    return made;
}

DirectLight shadow(const ShadowMap& technique, const ShadowMaps& maps, const Scene& scene, const Intersector& intersector,
                   const LightSampler& lights, const GBuffer& g, std::uint32_t seed) {
    DirectLight result(g.width, g.height);
    parallel_blocks(g.pixels(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) result.radiance[pixel] = vec3(0);
    });
    if (scene.geometry->triangle_count() == 0) return result;
    if (maps.lights.size() != static_cast<std::size_t>(lights.delta_count()))
        throw std::invalid_argument("shadow: maps of " + std::to_string(maps.lights.size()) + " lights, the scene has " +
                                    std::to_string(lights.delta_count()));
    const auto bias = static_cast<float>(technique.bias);
    for (int i = 0; i < lights.delta_count(); ++i) {
        const DepthMaps& own = maps.lights[static_cast<std::size_t>(i)];
        if (lights.delta_is_directional(i))
            add_directional_light(result, lights.delta(i, vec3(0)), own.maps.front(), bias, scene, g);
        else
            add_positional_light(result, i, own, bias, scene, lights, g);
    }
    add_emitters(result, technique.samples, scene, intersector, lights, g, seed);
    return result;
}

DirectLight shadow(const ShadowMap& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& g, std::uint32_t seed) {
    const ShadowMaps maps = shadow_maps(technique, scene, intersector);
    DirectLight result = shadow(technique, maps, scene, intersector, lights, g, seed);
    result.counts += maps.counts;
    return result;
}

}  // namespace interreflect
