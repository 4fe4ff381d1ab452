#include "voxels/march/traced_rays.h"

#include <array>
#include <vector>

#include "data/environment.h"
#include "math/owen_sobol.h"
#include "math/parallel.h"
#include "math/sampling.h"
#include "shading/brdf.h"
#include "shading/pixel_lobe.h"
#include "voxels/march/gather.h"
#include "voxels/march/voxel_lookup.h"

namespace interreflect {
namespace {

constexpr int chunk_size = 16;  // pixels on a side of what one thread does at a time
constexpr int capacity = chunk_size * chunk_size;

/// What both stages share: pixels of a chunk trace their phase's samples together, one sample of all pixels after the other.
struct Tracer {
    const TracedRays& technique;
    Pyramids pyramids;
    const GBuffer& gbuffer;
    const Scene& scene;
    const Intersector& intersector;
    Block block;
    std::uint32_t seed;

    /// Samples i of `samples` with i mod phases = phase.
    int samples_of(int phase) const { return (technique.samples - phase + block.phases() - 1) / block.phases(); }
    std::uint32_t key(int x, int y, std::uint32_t stage) const {
        const int columns = (gbuffer.width + technique.tile - 1) / technique.tile;
        const auto tile = static_cast<std::uint32_t>(x / technique.tile + columns * (y / technique.tile));
        return hash_combine(hash_combine(seed, stage), tile);
    }
    vec3 offset_origin(std::size_t pixel) const {
        const GBuffer& g = gbuffer;
        const float offset = self_hit_offset(*scene.geometry, g.instance[pixel], g.triangle[pixel]);
        return g.position[pixel] + g.geometric_normal[pixel] * offset;
    }
    void trace(std::span<const Ray> rays, std::span<Hit> hits) const {
        if (technique.tile > 1)
            intersector.nearest_coherent(rays, hits);
        else
            intersector.nearest_incoherent(rays, hits);
    }
    std::vector<float> phase_weights() const {
        std::vector<float> weights(static_cast<std::size_t>(block.phases()));
        for (int phase = 0; phase < block.phases(); ++phase)
            weights[phase] = static_cast<float>(samples_of(phase)) / static_cast<float>(technique.samples);
        return weights;
    }
};

vec2 sample_point(int index, std::uint32_t key) {
    const Bits2 bits = owen_sobol(static_cast<std::uint32_t>(index), key);
    return {unit_float(bits.x), unit_float(bits.y)};
}

/// One ray of one pixel, and how much of the pixel's result it is.
struct Sample {
    std::size_t pixel;
    vec3 weight;
};

/// Traces up to `capacity` rays and hands each sample its radiance from voxels, that from the environment, and whether it is
/// open.
template <class Add>
void trace_samples(const Tracer& tracer, std::span<const Ray> rays, std::span<const Sample> samples, const Add& add) {
    std::array<Hit, capacity> hits;
    tracer.trace(rays, std::span(hits).first(rays.size()));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const bool open = !hits[i].valid();
        const vec3 voxels = open ? vec3(0) : radiance_at_hit(tracer.pyramids, tracer.scene, hits[i], rays[i].direction);
        const vec3 sky = open ? environment_radiance(tracer.scene, rays[i].direction) : vec3(0);
        add(samples[i], voxels, sky, open);
    }
}

/// Calls choose(pixel, point) -> {direction, weight} for every sample of every pixel that `wanted` names, and adds up what its
/// rays find. Samples below the surface count as zero without a ray.
template <class Wanted, class Choose, class Add>
Counts trace_pixels(const Tracer& tracer, std::uint32_t stage, const Tile& tile, const Wanted& wanted, const Choose& choose,
                    const Add& add) {
    const GBuffer& g = tracer.gbuffer;
    std::array<Ray, capacity> rays;
    std::array<Sample, capacity> samples;
    Counts counts;
    for (int index = 0; index < tracer.samples_of(0); ++index) {
        std::size_t count = 0;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * g.width + x;
                if (!g.hit(pixel) || !wanted(pixel) || index >= tracer.samples_of(tracer.block.phase(x, y))) continue;
                const auto [direction, weight] = choose(pixel, sample_point(index, tracer.key(x, y, stage)));
                if (glm::dot(direction, g.geometric_normal[pixel]) <= 0.0f || weight == vec3(0)) continue;
                rays[count] = Ray{tracer.offset_origin(pixel), 0.0f, direction};
                samples[count++] = {pixel, weight};
            }
        counts.rays += count;
        trace_samples(tracer, std::span<const Ray>(rays).first(count), std::span<const Sample>(samples).first(count), add);
    }
    return counts;
}

struct Choice {
    vec3 direction, weight;
};

constexpr std::uint32_t march_stage = 1, glossy_stage = 2;

}  // namespace

GatheredLight march(const TracedRays& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene,
                    const Intersector& intersector, const Share& share, std::uint32_t seed) {
    const Tracer tracer{technique, pyramids, gbuffer, scene, intersector, block_of(share), seed};
    const vec3 each(1.0f / static_cast<float>(technique.samples));
    Buffer<vec4> voxels(gbuffer.pixels(), vec4(0)), sky(gbuffer.pixels(), vec4(0));
    std::vector<Counts> counts(gbuffer.pixels() / capacity + gbuffer.width + gbuffer.height + 1);
    parallel_tiles(gbuffer.width, gbuffer.height, chunk_size, [&](const Tile& tile) {
        counts[tile.index] = trace_pixels(
            tracer, march_stage, tile, [](std::size_t) { return true; },
            [&](std::size_t pixel, const vec2& u) {
                return Choice{Frame(gbuffer.normal[pixel]).to_world(cosine_hemisphere(u)), each};
            },
            [&](const Sample& sample, const vec3& radiance, const vec3& outside, bool open) {
                voxels[sample.pixel] += vec4(radiance, open ? 1.0f : 0.0f) * sample.weight.x;
                sky[sample.pixel] += vec4(outside * sample.weight, 0.0f);
            });
    });
    const auto weights = tracer.phase_weights();
    return merge_gathered(share, gbuffer, weights, voxels, pi, sky, vec3(0), counts);
}

GlossyLight glossy(const TracedRays& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene,
                   const Intersector& intersector, std::uint32_t seed) {
    const Tracer tracer{technique, pyramids, gbuffer, scene, intersector, Block{}, seed};
    const float each = 1.0f / static_cast<float>(technique.samples);
    Buffer<vec4> voxels(gbuffer.pixels(), vec4(0)), sky(gbuffer.pixels(), vec4(0));
    std::vector<Counts> counts(gbuffer.pixels() / capacity + gbuffer.width + gbuffer.height + 1);
    parallel_tiles(gbuffer.width, gbuffer.height, chunk_size, [&](const Tile& tile) {
        counts[tile.index] = trace_pixels(
            tracer, glossy_stage, tile, [&](std::size_t pixel) { return max_component(gbuffer.specular[pixel]) > 0.0f; },
            [&](std::size_t pixel, const vec2& u) {
                const vec3 wo = glm::normalize(gbuffer.camera.position - gbuffer.position[pixel]);
                const BrdfSample sample = sample_brdf(glossy_surface(gbuffer, scene, pixel), wo, 0.0f, u);
                return Choice{sample.wi, sample.weight * each};
            },
            [&](const Sample& sample, const vec3& radiance, const vec3& outside, bool) {
                voxels[sample.pixel] += vec4(radiance * sample.weight, 0.0f);
                sky[sample.pixel] += vec4(outside * sample.weight, 0.0f);
            });
    });
    return finish_glossy(gbuffer, voxels, 1.0f, sky, counts);
}

}  // namespace interreflect
