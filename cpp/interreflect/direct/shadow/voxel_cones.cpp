#include "direct/shadow/voxel_cones.h"

#include <algorithm>
#include <array>
#include <vector>

#include "direct/pixel_surface.h"
#include "direct/pixel_tiles.h"
#include "shading/brdf.h"
#include "voxels/march/cone_caster.h"

namespace interreflect {
namespace {

static_assert(tile_pixels <= ConeBatch::capacity);

/// Adds what one tile's pixels reflect of one light.
Counts add_light(DirectLight& result, int number, const TilePixels& pixels, const ShadowCones& shadows, const Scene& scene,
                 const LightSampler& lights, const GBuffer& g) {
    std::vector<ConeCaster::Cone> cones;
    std::array<vec3, tile_pixels> reflected;
    std::array<std::size_t, tile_pixels> target;
    std::array<float, tile_pixels> open;
    for (const std::size_t pixel : pixels) {
        const LightSampler::Delta light = lights.delta(number, g.position[pixel]);
        const float cosine = glm::dot(g.normal[pixel], light.direction);
        if (!(cosine > 0.0f) || !(max_component(light.irradiance) > 0.0f)) continue;
        const PixelSurface surface(g, scene, pixel);
        const vec3 radiance = evaluate_brdf(surface.point, surface.to_viewer, light.direction) * light.irradiance * cosine;
        if (!(max_component(radiance) > 0.0f)) continue;
        reflected[cones.size()] = radiance;
        target[cones.size()] = pixel;
        cones.push_back({g.position[pixel], g.geometric_normal[pixel], light.direction, light.distance, g.body[pixel]});
    }
    const Counts counts = shadows.open(cones, std::span<float>(open).first(cones.size()));
    for (std::size_t i = 0; i < cones.size(); ++i) result.radiance[target[i]] += reflected[i] * open[i];
    return counts;
}

}  // namespace

DirectLight shadow(const VoxelCones& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& g, std::span<const Pyramid* const> pyramids, std::uint32_t seed) {
    DirectLight result(g.width, g.height);
    const ShadowCones shadows(pyramids, technique, static_cast<float>(technique.half_angle) * degrees_to_radians);
    std::vector<Counts> counts(tile_count(g));
    for_each_tile(g, [&](const TilePixels& pixels) {
        for (const std::size_t pixel : pixels.all()) result.radiance[pixel] = vec3(0);
        for (int i = 0; i < lights.delta_count(); ++i)
            counts[pixels.tile()] += add_light(result, i, pixels, shadows, scene, lights, g);
    });
    for (const Counts& one : counts) result.counts += one;
    add_emitters(result, technique.samples, scene, intersector, lights, g, seed);
    return result;
}

}  // namespace interreflect
