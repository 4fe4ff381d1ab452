#include "surfels/evaluate/spherical_harmonic_lobes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "math/parallel.h"
#include "math/spherical_harmonics.h"
#include "surfels/evaluate/cache_finder.h"
#include "voxels/glossy/reflections.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16;  // pixels
static_assert(tile_size * tile_size <= Reflections::capacity);

/// Weights of the caches' coefficients for a lobe: how much of y each band passes on, at a direction.
struct LobeWeights {
    float value[most_bands * most_bands];

    LobeWeights(const vec3& axis, int bands, const float* scale) {
        spherical_harmonics(axis, bands, [&](int i, float y) { value[i] = y; });
        for (int l = 0; l < bands; ++l)
            for (int i = l * l; i < (l + 1) * (l + 1); ++i) value[i] *= scale[l];
    }
};

/// Mean radiance over a lobe.
vec3 over_lobe(const LightCaches& caches, const NearCaches& near, const LobeWeights& lobe) {
    vec3 mean(0);
    const int luma = caches.luma(), chrominance = caches.chrominance();
    for (int k = 0; k < near.count; ++k) {
        const float* c =
            caches.coefficients.data() + near.cache[static_cast<std::size_t>(k)] * static_cast<std::size_t>(caches.stride());
        vec3 sum(0);
        for (int i = 0; i < luma; ++i) sum.x += c[i] * lobe.value[i];
        for (int i = 0; i < chrominance; ++i) {
            sum.y += c[luma + i] * lobe.value[i];
            sum.z += c[luma + chrominance + i] * lobe.value[i];
        }
        mean += sum * near.weight[static_cast<std::size_t>(k)];
    }
    if (caches.ycocg) {
        const float t = mean.x - mean.z;  // (Y, Co, Cg) to (R, G, B)
        mean = {t + mean.y, mean.x + mean.z, t - mean.y};
    }
    return glm::max(mean, vec3(0));
}

/// The power of the cosine whose mean cosine is that of a uniform cone: (n + 1) / (n + 2) = (1 + cos a) / 2.
float exponent_of(float half_angle) {
    const float mean = 0.5f * (1.0f + std::cos(half_angle));
    return std::max((2.0f * mean - 1.0f) / std::max(1.0f - mean, 1e-6f), 0.0f);
}

}  // namespace

SurfelLight evaluate(const SphericalHarmonicLobes&, const LightCaches& caches, const CacheSites& sites, const GBuffer& gbuffer,
                     const Scene& scene) {
    if (caches.caches != sites.size()) throw std::invalid_argument("evaluate: light of another number of caches");
    SurfelLight light = empty_surfel_light(gbuffer);
    const CacheFinder finder(sites, gbuffer, scene);
    const LobeTables tables(gbuffer, scene);
    float cosine[most_bands];
    for (int l = 0; l < most_bands; ++l) cosine[l] = lobe_scale(l, 1.0f);
    std::vector<Counts> counts(tile_count(gbuffer.width, gbuffer.height, tile_size));
    parallel_tiles(gbuffer.width, gbuffer.height, tile_size, [&](const Tile& tile) {
        const auto lobes = std::make_unique<Reflections>();
        NearCaches near_lobes[Reflections::capacity];
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width) + static_cast<std::size_t>(x);
                light.gathered.irradiance[pixel] = light.glossy.radiance[pixel] = vec3(0);
                const NearCaches near = finder.find(pixel);
                if (!gbuffer.hit(pixel)) continue;
                counts[tile.index].cache_evaluations += static_cast<std::uint64_t>(near.count);
                ++(near.count > 0 ? counts[tile.index].covered_pixels : counts[tile.index].uncovered_pixels);
                const LobeWeights diffuse(gbuffer.normal[pixel], caches.bands, cosine);
                light.gathered.irradiance[pixel] = pi * over_lobe(caches, near, diffuse);
                if (near.count > 0 && max_component(gbuffer.specular[pixel]) > 0.0f) {
                    near_lobes[lobes->count] = near;
                    lobes->add(gbuffer, tables, pixel);
                }
            }
        if (lobes->count > 0 && !gbuffer.seen_head_on) find_lobes(tables, gbuffer.camera.position, false, *lobes);
        for (int i = 0; i < lobes->count; ++i) {
            float scale[most_bands];
            const float exponent = exponent_of(lobes->half_angle[i]);
            for (int l = 0; l < caches.bands; ++l) scale[l] = lobe_scale(l, exponent);
            const std::size_t pixel = lobes->pixel[i];
            const vec3 mean = over_lobe(caches, near_lobes[i], LobeWeights(lobes->cone(i), caches.bands, scale));
            light.glossy.radiance[pixel] = mean * lobes->albedo(i, gbuffer.specular[pixel]);
        }
    });
    for (const Counts& one : counts) light.counts += one;
    return light;
}

}  // namespace interreflect
