#include "surfels/evaluate/spherical_harmonic_lobes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include "math/parallel.h"
#include "surfels/evaluate/cache_finder.h"
#include "surfels/evaluate/lobe_sums.h"
#include "voxels/glossy/reflections.h"

namespace interreflect {
namespace {

constexpr int run = NearCaches::length;
constexpr std::size_t pixels_a_block = 16 * run;
static_assert(run <= Reflections::capacity);

/// The power of the cosine whose mean cosine is that of a uniform cone: (n + 1) / (n + 2) = (1 + cos a) / 2.
float exponent_of(float half_angle) {
    const float mean = 0.5f * (1.0f + std::cos(half_angle));
    return std::max((2.0f * mean - 1.0f) / std::max(1.0f - mean, 1e-6f), 0.0f);
}

/// Evaluates runs of pixels, one after the other.
class Runs {
  public:
    Runs(const LightCaches& caches, const CacheFinder& finder, const LobeTables& tables, const GBuffer& gbuffer,
         SurfelLight& light)
        : caches_(caches), finder_(finder), tables_(tables), g_(gbuffer), light_(light) {}

    Counts evaluate(std::size_t first, int count) {
        finder_.find(first, count, near_);
        near_.count(count, used_);
        std::copy_n(g_.normal.data() + first, count, lobes_.axis);
        sum_cosines(caches_, near_, count, lobes_);
        vec3* const irradiance = light_.gathered.irradiance.data() + first;
        for (int i = 0; i < count; ++i) irradiance[i] = pi * lobes_.mean[i];
        std::fill_n(light_.glossy.radiance.data() + first, count, vec3(0));
        std::uint64_t hits = 0, covered = 0, evaluations = 0;
        for (int i = 0; i < count; ++i) hits += g_.hit(first + static_cast<std::size_t>(i)) ? 1 : 0;
        for (int i = 0; i < count; ++i) covered += used_[i] > 0 ? 1 : 0, evaluations += static_cast<std::uint64_t>(used_[i]);
        Counts counts;
        counts.cache_evaluations = evaluations, counts.covered_pixels = covered, counts.uncovered_pixels = hits - covered;
        if (!tables_.empty()) reflect(first, count);
        return counts;
    }

  private:
    /// The glossy lobes of a run.
    void reflect(std::size_t first, int count) {
        reflections_.count = 0;
        for (int i = 0; i < count; ++i) {
            const std::size_t pixel = first + static_cast<std::size_t>(i);
            if (!g_.hit(pixel) || !(max_component(g_.specular[pixel]) > 0.0f) || used_[i] == 0) continue;
            const int to = reflections_.count;
            for (int k = 0; k < near_.slots; ++k)
                near_.cache[k][to] = near_.cache[k][i], near_.weight[k][to] = near_.weight[k][i];
            reflections_.add(g_, tables_, pixel);
        }
        if (reflections_.count == 0 || g_.seen_head_on) return;
        find_lobes(tables_, g_.camera.position, false, reflections_);
        for (int i = 0; i < reflections_.count; ++i) {
            lobes_.axis[i] = reflections_.cone(i);
            lobes_.exponent[i] = exponent_of(reflections_.half_angle[i]);
        }
        sum_lobes(caches_, near_, reflections_.count, lobes_);
        for (int i = 0; i < reflections_.count; ++i) {
            const std::size_t pixel = reflections_.pixel[i];
            light_.glossy.radiance[pixel] = lobes_.mean[i] * reflections_.albedo(i, g_.specular[pixel]);
        }
    }

    const LightCaches& caches_;
    const CacheFinder& finder_;
    const LobeTables& tables_;
    const GBuffer& g_;
    SurfelLight& light_;
    NearCaches near_;
    std::int32_t used_[run];
    Lobes lobes_;
    Reflections reflections_;
};

}  // namespace

SurfelLight evaluate(const SphericalHarmonicLobes&, const LightCaches& caches, const CacheSites& sites, const GBuffer& gbuffer,
                     const Scene& scene) {
    if (caches.caches != sites.size()) throw std::invalid_argument("evaluate: light of another number of caches");
    SurfelLight light = empty_surfel_light(gbuffer);
    const CacheFinder finder(sites, gbuffer);
    const LobeTables tables(gbuffer, scene);
    std::vector<Counts> counts((gbuffer.pixels() + pixels_a_block - 1) / pixels_a_block);
    parallel_blocks(gbuffer.pixels(), pixels_a_block, [&](std::size_t begin, std::size_t end) {
        const auto runs = std::make_unique<Runs>(caches, finder, tables, gbuffer, light);
        for (std::size_t first = begin; first < end; first += run)
            counts[begin / pixels_a_block] += runs->evaluate(first, static_cast<int>(std::min<std::size_t>(run, end - first)));
    });
    for (const Counts& one : counts) light.counts += one;
    return light;
}

}  // namespace interreflect
