#include "direct/shadow/traced_shadows.h"

#include <algorithm>
#include <array>
#include <vector>

#include "direct/pixel_surface.h"
#include "direct/pixel_tiles.h"
#include "math/stratified.h"
#include "shading/brdf.h"
#include "shading/emitter_batch.h"

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

/// Shadow rays towards delta lights, sixteen at a time as pixels deliver them.
class ShadowPackets {
  public:
    ShadowPackets(DirectLight& result, const Intersector& intersector) : result_(result), intersector_(intersector) {}

    void add(const Ray& ray, const vec3& reflected, std::size_t pixel) {
        packet_.set(count_, ray);
        reflected_[count_] = reflected;
        pixel_[count_] = pixel;
        if (++count_ == RayPacket::width) flush();
    }
    void flush() {
        const std::uint32_t active = (1U << count_) - 1U;
        const std::uint32_t open = active & ~(active != 0 ? intersector_.occluded(packet_, active) : 0U);
        for (int i = 0; i < count_; ++i)
            if (((open >> i) & 1U) != 0) result_.radiance[pixel_[i]] += reflected_[i];
        rays_ += static_cast<std::size_t>(count_);
        count_ = 0;
    }
    std::size_t rays() const { return rays_; }

  private:
    RayPacket packet_;  // first: it is aligned to 64 bytes
    DirectLight& result_;
    const Intersector& intersector_;
    std::array<std::size_t, RayPacket::width> pixel_;
    std::size_t rays_ = 0;
    std::array<vec3, RayPacket::width> reflected_;
    int count_ = 0;
};

/// What a pixel reflects of a delta light that nothing hides.
vec3 reflected_light(const PixelSurface& surface, const LightSampler::Delta& delta) {
    const vec3 f = evaluate_brdf(surface.point, surface.to_viewer, delta.direction);
    return f * delta.irradiance * glm::dot(surface.point.normal, delta.direction);
}

/// It ends short of the surface of a light that lies there.
Ray shadow_ray(const GBuffer& g, std::size_t pixel, const LightSampler::Delta& light) {
    const float offset = g.offset[pixel];
    return {g.position[pixel] + g.geometric_normal[pixel] * offset, 0.0f, light.direction,
            light.distance * (1.0f - 0x1p-14f) - 2.0f * offset};
}

/// `light_at`: the light as seen from a position. Most surfaces are diffuse: what faces away costs a look at two normals.
template <class LightAt>
void trace_delta_light(const LightAt& light_at, const Tile& tile, ShadowPackets& packets, const Scene& scene, const GBuffer& g) {
    for_each_pixel(tile, g.width, [&](std::size_t pixel) {
        const vec3 position = g.position[pixel], normal = g.normal[pixel];
        const LightSampler::Delta& light = light_at(position);
        const float cosine = glm::dot(normal, light.direction);  // 0 where nothing was hit
        if (!(cosine > 0.0f) || glm::dot(g.geometric_normal[pixel], light.direction) <= 0.0f) return;
        if (max_component(light.irradiance) <= 0.0f) return;
        const bool glossy = max_component(g.specular[pixel]) > 0.0f;
        if (!glossy && !g.seen_head_on && glm::dot(normal, g.camera.position - position) <= 0.0f) return;
        const vec3 reflected = glossy ? reflected_light(PixelSurface(g, scene, pixel), light)
                                      : g.albedo[pixel] * light.irradiance * (cosine * (1.0f / pi));
        if (!(max_component(reflected) > 0.0f)) return;
        packets.add(shadow_ray(g, pixel, light), reflected, pixel);
    });
}

/// A point on an emitter, weighted against the lobe's own samples where there are such.
void add_light_sample(Pending& pending, const PixelSurface& surface, std::size_t pixel, const LightDirection& light,
                      int samples) {
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
        EmitterBatch batch;
        std::array<std::size_t, EmitterBatch::width> pixel_of;
        const auto finish = [&] {
            sample_emitters(lights, batch);
            for (int k = 0; k < batch.count; ++k)
                add_light_sample(pending, PixelSurface(g, scene, pixel_of[k]), pixel_of[k], batch.light[k], samples);
            batch.count = 0;
        };
        for (int i = 0; i < samples; ++i) {
            for (const std::size_t pixel : pixels) {
                const PixelSurface surface(g, scene, pixel);
                if (!surface.reflects()) continue;
                const auto key = static_cast<std::uint32_t>(pixel);
                const StratifiedPoints points(seed, key, 0);
                pixel_of[batch.count] = pixel;
                batch.add(surface.point.position, points.choice(i), points.point(i));
                if (batch.count == EmitterBatch::width) finish();
                if (!surface.glossy()) continue;
                light.radiance[pixel] += brdf_sample(surface, {seed, key, 1}, i, samples, scene, intersector, lights);
                ++counts[pixels.tile()].rays;
            }
            finish();
            counts[pixels.tile()].shadow_rays += pending.count;
            pending.flush(light, [&](auto queries, auto blocked) { intersector.occluded_incoherent(queries, blocked); });
        }
    });
    for (const Counts& one : counts) light.counts += one;
}

DirectLight shadow(const TracedShadows& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& g, std::uint32_t seed) {
    DirectLight result(g.width, g.height);
    // Wide tiles: every image is read in long runs of its rows.
    constexpr int side = 64;
    std::vector<Counts> counts(tile_count(g, side));
    const int directional = static_cast<int>(scene.directional_lights.size()), positional = lights.delta_count() - directional;
    parallel_tiles(g.width, g.height, side, [&](const Tile& tile) {
        for (int y = tile.y0; y < tile.y1; ++y) {
            vec3* const row = &result.radiance[static_cast<std::size_t>(y) * g.width];
            std::fill(row + tile.x0, row + tile.x1, vec3(0));
        }
        for (int i = 0; i < lights.delta_count(); ++i) {
            ShadowPackets packets(result, intersector);
            if (i < positional) {
                trace_delta_light([&](const vec3& position) { return lights.delta(i, position); }, tile, packets, scene, g);
            } else {
                const LightSampler::Delta sun = lights.delta(i, vec3(0));
                trace_delta_light([&sun](const vec3&) -> const LightSampler::Delta& { return sun; }, tile, packets, scene, g);
            }
            packets.flush();
            counts[tile.index].shadow_rays += packets.rays();
        }
    });
    for (const Counts& one : counts) result.counts += one;
    add_emitters(result, technique.samples, scene, intersector, lights, g, seed);
    return result;
}

}  // namespace interreflect
