#include "direct/sky/traced_sky.h"

#include <algorithm>
#include <array>
#include <vector>

#include "direct/pixel_surface.h"
#include "direct/pixel_tiles.h"
#include "direct/surface_filter.h"
#include "math/stratified.h"
#include "shading/brdf.h"

namespace interreflect {
namespace {

/// One ray of a tile and what it brings where nothing is in its way.
struct SkyRays {
    static constexpr std::size_t capacity = tile_pixels;
    std::array<Ray, capacity> rays;
    std::array<vec3, capacity> light;
    std::array<std::size_t, capacity> pixel;
    std::size_t count = 0;

    void add(const PixelSurface& surface, std::size_t to, const vec3& direction, const vec3& value) {
        if (!(max_component(value) > 0.0f)) return;
        rays[count] = {surface.ray_origin(), 0.0f, direction};
        light[count] = value;
        pixel[count++] = to;
    }
    std::size_t flush(Buffer<vec3>& sums, const Intersector& intersector) {
        std::array<std::uint8_t, capacity> blocked;
        intersector.occluded_incoherent({rays.data(), count}, {blocked.data(), count});
        for (std::size_t i = 0; i < count; ++i)
            if (blocked[i] == 0) sums[pixel[i]] += light[i];
        return std::exchange(count, 0);
    }
};

struct Sampler {
    const LightSampler& lights;
    bool image;  // the environment is worth sampling by itself
    float share;

    /// Light along a direction of the surface's own reflection, weighted.
    void add_brdf(SkyRays& rays, const PixelSurface& surface, std::size_t pixel, const StratifiedPoints& points, int i) const {
        const BrdfSample s = sample_brdf(surface.point, surface.to_viewer, points.choice(i), points.point(i));
        if (!(s.pdf > 0.0f)) return;
        const float other = image ? lights.environment_pdf(s.wi) : 0.0f;
        rays.add(surface, pixel, s.wi, s.weight * lights.environment(s.wi) * (share * s.pdf / (s.pdf + other)));
    }
    /// Light along a direction where the environment is bright, weighted.
    void add_environment(SkyRays& rays, const PixelSurface& surface, std::size_t pixel, const StratifiedPoints& points,
                         int i) const {
        const LightSampler::Area light = lights.sample_environment(points.point(i));
        if (!(light.pdf > 0.0f)) return;
        const BrdfValue f = evaluate_brdf_and_pdf(surface.point, surface.to_viewer, light.direction);
        const float cosine = glm::dot(surface.point.normal, light.direction);
        rays.add(surface, pixel, light.direction, f.value * light.radiance * (share * cosine / (light.pdf + f.pdf)));
    }
};

/// The surface with one of its two reflections alone; `diffuse` as white as paper that returns the irradiance itself.
PixelSurface only(PixelSurface surface, bool diffuse) {
    surface.point.albedo = diffuse ? vec3(pi) : vec3(0);
    if (diffuse) surface.point.specular = vec3(0);
    return surface;
}

/// Estimates one reflection of a tile's pixels into `sums`; returns the number of rays.
std::size_t sample_tile(const Sampler& sampler, bool diffuse, int samples, const TilePixels& pixels, Buffer<vec3>& sums,
                        const Scene& scene, const Intersector& intersector, const GBuffer& g, std::uint32_t seed) {
    SkyRays rays;
    std::size_t traced = 0;
    for (int i = 0; i < samples; ++i)
        for (const bool environment : {false, true}) {
            if (environment && !sampler.image) continue;
            for (const std::size_t pixel : pixels) {
                const PixelSurface whole(g, scene, pixel);
                if (diffuse ? max_component(whole.point.albedo) <= 0.0f : !whole.glossy()) continue;
                const PixelSurface surface = only(whole, diffuse);
                const std::uint32_t purpose = 2U + (diffuse ? 0U : 2U) + (environment ? 1U : 0U);
                const StratifiedPoints points(seed, static_cast<std::uint32_t>(pixel), purpose);
                if (environment)
                    sampler.add_environment(rays, surface, pixel, points, i);
                else
                    sampler.add_brdf(rays, surface, pixel, points, i);
            }
            traced += rays.flush(sums, intersector);
        }
    return traced;
}

}  // namespace

DirectLight sky(const TracedSky& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                const GBuffer& g, std::uint32_t seed) {
    DirectLight result(g.width, g.height);
    if (!lights.has_environment()) {
        std::ranges::fill(result.radiance, vec3(0));
        return result;
    }
    Buffer<vec3> irradiance(g.pixels());
    const Sampler sampler{lights, !lights.environment_is_constant(), 1.0f / static_cast<float>(technique.samples)};
    std::vector<Counts> counts(tile_count(g));
    for_each_tile(g, [&](const TilePixels& pixels) {
        for (const std::size_t pixel : pixels.all()) result.radiance[pixel] = irradiance[pixel] = vec3(0);
        Counts& count = counts[pixels.tile()];
        count.shadow_rays = sample_tile(sampler, true, technique.samples, pixels, irradiance, scene, intersector, g, seed) +
                            sample_tile(sampler, false, technique.samples, pixels, result.radiance, scene, intersector, g, seed);
    });
    for (const Counts& one : counts) result.counts += one;
    if (technique.filter_radius > 0) irradiance = filter_along_surfaces(irradiance, g, technique.filter_radius);
    parallel_blocks(g.pixels(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (g.hit(i)) result.radiance[i] += g.albedo[i] * irradiance[i] / pi;
    });
    return result;
}

}  // namespace interreflect
