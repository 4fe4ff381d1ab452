#include "direct/shadow/traced_shadows.h"

#include <array>
#include <vector>

#include "direct/pixel_surface.h"
#include "direct/pixel_tiles.h"
#include "math/stratified.h"
#include "shading/brdf.h"

namespace interreflect {
namespace {

/// Rays of one tile that are waiting to be traced, and what each adds to its pixel where nothing is in its way.
struct Pending {
    static constexpr std::size_t capacity = tile_pixels;
    std::array<Ray, capacity> rays;
    std::array<vec3, capacity> light;
    std::array<std::size_t, capacity> pixel;
    std::size_t count = 0;

    void add(const Ray& ray, const vec3& radiance, std::size_t to) {
        rays[count] = ray;
        light[count] = radiance;
        pixel[count++] = to;
    }
    template <class Trace>
    void flush(DirectLight& result, const Trace& trace) {
        std::array<std::uint8_t, capacity> blocked;
        trace(std::span<const Ray>(rays.data(), count), std::span<std::uint8_t>(blocked.data(), count));
        for (std::size_t i = 0; i < count; ++i)
            if (blocked[i] == 0) result.radiance[pixel[i]] += light[i];
        count = 0;
    }
};

/// One light, all pixels of the tile; returns how many rays it took.
std::size_t trace_delta_light(int number, const TilePixels& pixels, DirectLight& result, const Scene& scene,
                              const Intersector& intersector, const LightSampler& lights, const GBuffer& g) {
    Pending pending;
    for (const std::size_t pixel : pixels) {
        const PixelSurface surface(g, scene, pixel);
        const LightSampler::Delta delta = lights.delta(number, surface.point.position);
        if (max_component(delta.irradiance) <= 0.0f) continue;
        const vec3 f = evaluate_brdf(surface.point, surface.to_viewer, delta.direction);
        const vec3 reflected = f * delta.irradiance * glm::dot(surface.point.normal, delta.direction);
        if (max_component(reflected) > 0.0f) pending.add(surface.shadow_ray(delta.direction, delta.distance), reflected, pixel);
    }
    const std::size_t rays = pending.count;
    pending.flush(result, [&](auto queries, auto blocked) { intersector.occluded_coherent(queries, blocked); });
    return rays;
}

/// The i-th point on an emitter, weighted against the lobe's own samples where there are such.
void add_light_sample(Pending& pending, const PixelSurface& surface, std::size_t pixel, const StratifiedPoints& points, int i,
                      int samples, const LightSampler& lights) {
    const auto light = lights.sample_emitter(surface.point.position, points.choice(i), points.point(i));
    if (!(light.pdf > 0.0f)) return;
    const BrdfValue f = evaluate_brdf_and_pdf(surface.point, surface.to_viewer, light.direction);
    const float density = light.pdf + (surface.glossy() ? f.pdf : 0.0f);
    const vec3 reflected =
        f.value * light.radiance * (glm::dot(surface.point.normal, light.direction) / (density * static_cast<float>(samples)));
    if (max_component(reflected) > 0.0f) pending.add(surface.shadow_ray(light.direction, light.distance), reflected, pixel);
}

/// The i-th direction of the surface's own reflection: what emitter does it meet?
vec3 brdf_sample(const PixelSurface& surface, const StratifiedPoints& points, int i, int samples, const Scene& scene,
                 const Intersector& intersector, const LightSampler& lights) {
    const BrdfSample s = sample_brdf(surface.point, surface.to_viewer, points.choice(i), points.point(i));
    if (!(s.pdf > 0.0f) || !(max_component(s.weight) > 0.0f)) return vec3(0);
    const Hit hit = intersector.nearest({surface.ray_origin(), 0.0f, s.wi});
    if (!hit.valid()) return vec3(0);
    const vec3 emission = surface_at(scene, hit, s.wi).emission;
    if (!(max_component(emission) > 0.0f)) return vec3(0);
    const float other = lights.emitter_pdf(hit, surface.point.position, s.wi);
    return s.weight * emission * (s.pdf / ((s.pdf + other) * static_cast<float>(samples)));
}

}  // namespace

void add_emitters(DirectLight& light, int samples, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                  const GBuffer& g, std::uint32_t seed) {
    if (!lights.has_emitters()) return;
    std::vector<Counts> counts(tile_count(g));
    for_each_tile(g, [&](const TilePixels& pixels) {
        Pending pending;
        for (int i = 0; i < samples; ++i) {
            for (const std::size_t pixel : pixels) {
                const PixelSurface surface(g, scene, pixel);
                if (!surface.reflects()) continue;
                const auto key = static_cast<std::uint32_t>(pixel);
                add_light_sample(pending, surface, pixel, {seed, key, 0}, i, samples, lights);
                if (!surface.glossy()) continue;
                light.radiance[pixel] += brdf_sample(surface, {seed, key, 1}, i, samples, scene, intersector, lights);
                ++counts[pixels.tile()].rays;
            }
            counts[pixels.tile()].shadow_rays += pending.count;
            pending.flush(light, [&](auto queries, auto blocked) { intersector.occluded_incoherent(queries, blocked); });
        }
    });
    for (const Counts& one : counts) light.counts += one;
}

DirectLight shadow(const TracedShadows& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& g, std::uint32_t seed) {
    DirectLight result(g.width, g.height);
    std::vector<Counts> counts(tile_count(g));
    for_each_tile(g, [&](const TilePixels& pixels) {
        for (const std::size_t pixel : pixels.all()) result.radiance[pixel] = vec3(0);
        for (int i = 0; i < lights.delta_count(); ++i)
            counts[pixels.tile()].shadow_rays += trace_delta_light(i, pixels, result, scene, intersector, lights, g);
    });
    for (const Counts& one : counts) result.counts += one;
    add_emitters(result, technique.samples, scene, intersector, lights, g, seed);
    return result;
}

}  // namespace interreflect
