#include "reference/path_tracing.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"
#include "math/sampling.h"
#include "reference/sample_sequence.h"
#include "shading/brdf.h"
#include "visibility/trace_gbuffer.h"

namespace interreflect {
namespace {

constexpr int tile_size = 32;
constexpr int samples_a_pass = 8;  // between two looks at the clock and at Ctrl-C
constexpr int everything = std::numeric_limits<int>::max();
constexpr float most_survival = 0.95f;  // roulette ends even a path that loses nothing

/// Pairs of random numbers: one for the place in the pixel, then so many a vertex.
enum Dimension : std::uint32_t { emitter_point, environment_point, reflection, choices, roulette, pairs_a_vertex };
std::uint32_t dimension(int vertex, Dimension which) { return 1 + static_cast<std::uint32_t>(vertex) * pairs_a_vertex + which; }

float power_heuristic(float a, float b) { return a > 0.0f ? 1.0f / (1.0f + (b / a) * (b / a)) : 0.0f; }

/// What one path adds, apart by how often the light was reflected.
struct Radiance {
    vec3 direct{0}, indirect{0};
    void add(int reflections, const vec3& radiance) { (reflections <= 1 ? direct : indirect) += radiance; }
};

struct Tracer {
    const Scene& scene;
    const Intersector& rays;
    const LightSampler& lights;
    CameraRays camera;
    int last_vertex;  // the last one that reflects
    PixelFilter pixel;
    std::uint32_t pattern;

    struct Stream {
        const SampleSequence& sequence;
        std::uint32_t sample, pattern;
        vec2 pair(int vertex, Dimension which) const { return sequence.pair(dimension(vertex, which), sample, pattern); }
    };

    /// Light of direction `wi` that nothing blocks, reflected towards wo; black below a horizon, without the ray.
    vec3 unblocked(const SurfacePoint& at, const vec3& wi, float distance, const vec3& light, Counts& counts) const {
        if (max_component(light) <= 0.0f) return vec3(0);
        ++counts.shadow_rays;
        const vec3 origin = at.position + at.geometric_normal * at.offset;
        // Short of an emitter by more than rounding moves either end.
        return rays.occluded({origin, 0.0f, wi, distance * 0.9999f - 2.0f * at.offset}) ? vec3(0) : light;
    }

    vec3 from_deltas(const SurfacePoint& at, const vec3& wo, Counts& counts) const {
        vec3 sum{0};
        for (int i = 0; i < lights.delta_count(); ++i) {
            const auto light = lights.delta(i, at.position);
            const float cosine = glm::dot(at.normal, light.direction);
            if (cosine <= 0.0f || max_component(light.irradiance) <= 0.0f) continue;
            const vec3 reflected = evaluate_brdf(at, wo, light.direction) * light.irradiance * cosine;
            sum += unblocked(at, light.direction, light.distance, reflected, counts);
        }
        return sum;
    }

    /// A sampled direction's share; `continues`: the reflection's own ray may find the same light.
    vec3 from_direction(const SurfacePoint& at, const vec3& wo, const LightDirection& light, bool continues,
                        Counts& counts) const {
        const float cosine = glm::dot(at.normal, light.direction);
        if (light.pdf <= 0.0f || cosine <= 0.0f) return vec3(0);
        const BrdfValue f = evaluate_brdf_and_pdf(at, wo, light.direction);
        const float weight = continues ? power_heuristic(light.pdf, f.pdf) : 1.0f;
        return unblocked(at, light.direction, light.distance, f.value * light.radiance * (cosine * weight / light.pdf), counts);
    }

    LightDirection sample_environment(const SurfacePoint& at, const vec2& u) const {
        if (!lights.environment_is_constant()) return lights.sample_environment(u);
        LightDirection light;
        const vec3 local = cosine_hemisphere(u);
        light.direction = Frame(at.normal).to_world(local);
        light.distance = std::numeric_limits<float>::infinity();
        light.radiance = lights.environment(light.direction);
        light.pdf = local.z / pi;
        return light;
    }
    float environment_pdf(const SurfacePoint& at, const vec3& direction) const {
        if (!lights.environment_is_constant()) return lights.environment_pdf(direction);
        return std::fmax(0.0f, glm::dot(at.normal, direction)) / pi;
    }

    vec3 from_lights(const SurfacePoint& at, const vec3& wo, int vertex, bool continues, const Stream& random,
                     Counts& counts) const {
        vec3 sum = from_deltas(at, wo, counts);
        if (lights.has_emitters()) {
            const float choose = random.pair(vertex, choices).x;
            sum += from_direction(at, wo, lights.sample_emitter(at.position, choose, random.pair(vertex, emitter_point)),
                                  continues, counts);
        }
        if (lights.has_environment())
            sum += from_direction(at, wo, sample_environment(at, random.pair(vertex, environment_point)), continues, counts);
        return sum;
    }

    /// Everything that leaves `at` towards wo = -direction, beyond its emission.
    void trace(SurfacePoint at, vec3 direction, const Stream& random, Radiance& out, Counts& counts) const {
        vec3 throughput{1};
        for (int vertex = 0; max_component(at.albedo) + max_component(at.specular) > 0.0f; ++vertex) {
            // A diffuse vertex that is the last finds its light by light samples alone.
            const bool continues = vertex < last_vertex || max_component(at.specular) > 0.0f || lights.emitters_are_many();
            out.add(vertex + 1, throughput * from_lights(at, -direction, vertex, continues, random, counts));
            if (!continues) return;
            const BrdfSample next = sample_brdf(at, -direction, random.pair(vertex, choices).y, random.pair(vertex, reflection));
            if (max_component(next.weight) <= 0.0f) return;
            throughput *= next.weight;
            if (last_vertex == everything && vertex >= 2) {
                const float survival = std::fmin(most_survival, max_component(throughput));
                if (random.pair(vertex, roulette).x >= survival) return;
                throughput /= survival;
            }
            ++counts.rays;
            const Hit hit = rays.nearest({at.position + at.geometric_normal * at.offset, 0.0f, next.wi});
            if (!hit.valid()) {
                if (lights.has_environment())
                    out.add(vertex + 1,
                            throughput * lights.environment(next.wi) * power_heuristic(next.pdf, environment_pdf(at, next.wi)));
                return;
            }
            const SurfacePoint seen = surface_at(scene, hit, next.wi);
            if (max_component(seen.emission) > 0.0f)
                out.add(vertex + 1,
                        throughput * seen.emission * power_heuristic(next.pdf, lights.emitter_pdf(hit, at.position, next.wi)));
            if (vertex == last_vertex) return;
            at = seen;
            direction = next.wi;
        }
    }

    Radiance sample_pixel(int x, int y, const Stream& random, Counts& counts) const {
        vec2 place(0.5f);
        if (pixel == PixelFilter::box) place = random.sequence.pair(0, random.sample, random.pattern);
        const float px = static_cast<float>(x) + place.x, py = static_cast<float>(y) + place.y;
        const vec3 direction = camera.direction(px, py);
        ++counts.rays, ++counts.paths;
        const Hit hit = rays.nearest({camera.origin, 0.0f, direction});
        Radiance out;
        if (!hit.valid()) {
            out.direct = lights.environment(direction);
            return out;
        }
        const Footprint footprint = pixel == PixelFilter::centre ? pixel_footprint(scene, hit, camera, px, py) : Footprint{};
        const SurfacePoint at = surface_at(scene, hit, direction, footprint);
        out.direct = at.emission;
        trace(at, direction, random, out, counts);
        return out;
    }
};

/// The bits of x and y in turn: neighbouring places get numbers that differ in high bits of a scrambled sequence's point.
std::uint32_t morton(std::uint32_t x, std::uint32_t y) {
    std::uint32_t code = 0;
    for (std::uint32_t bit = 0; bit < 16; ++bit) code |= ((x >> bit & 1U) << (2 * bit)) | ((y >> bit & 1U) << (2 * bit + 1));
    return code;
}

void check(const PathTracingSettings& s) {
    if (s.samples < 1) throw std::invalid_argument("samples must be at least 1, got " + std::to_string(s.samples));
    if (s.bounces && *s.bounces < 0)
        throw std::invalid_argument("bounces must not be negative, got " + std::to_string(*s.bounces));
    if (s.milliseconds && !(*s.milliseconds > 0.0)) throw std::invalid_argument("milliseconds must be positive");
    if (s.pattern < 1 || s.pattern > tile_size)
        throw std::invalid_argument("pattern must lie in [1, " + std::to_string(tile_size) + "], got " +
                                    std::to_string(s.pattern));
}

}  // namespace

PathTraced path_trace(const Scene& scene, const Intersector& intersector, const LightSampler& lights, const Camera& camera,
                      int width, int height, const PathTracingSettings& settings) {
    check(settings);
    check_view(camera, width, height);
    const auto begin = std::chrono::steady_clock::now();
    const Tracer tracer{scene,
                        intersector,
                        lights,
                        CameraRays(camera, width, height),
                        settings.bounces.value_or(everything),
                        settings.pixel,
                        static_cast<std::uint32_t>(settings.pattern)};
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    Buffer<glm::dvec3> direct(pixels, glm::dvec3(0)), indirect(pixels, glm::dvec3(0));
    const int columns = (width + tile_size - 1) / tile_size, rows = (height + tile_size - 1) / tile_size;
    std::vector<Counts> counts(static_cast<std::size_t>(columns) * rows);
    PathTraced result;
    for (int first = 0; first < settings.samples;) {
        const int end = settings.milliseconds ? first + 1 : std::min(first + samples_a_pass, settings.samples);
        parallel_tiles(width, height, tile_size, [&](const Tile& tile) {
            const SampleSequence sequence(settings.seed, static_cast<std::uint32_t>(tile.index));
            for (int y = tile.y0; y < tile.y1; ++y)
                for (int x = tile.x0; x < tile.x1; ++x)
                    for (int s = first; s < end; ++s) {
                        const std::uint32_t k = morton(static_cast<std::uint32_t>(x - tile.x0) % tracer.pattern,
                                                       static_cast<std::uint32_t>(y - tile.y0) % tracer.pattern);
                        const Radiance one =
                            tracer.sample_pixel(x, y, {sequence, static_cast<std::uint32_t>(s), k}, counts[tile.index]);
                        const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
                        direct[pixel] += glm::dvec3(one.direct);
                        indirect[pixel] += glm::dvec3(one.indirect);
                    }
        });
        first = result.samples = end;
        const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - begin;
        if (settings.milliseconds && spent.count() >= *settings.milliseconds) break;
    }
    result.width = width, result.height = height;
    result.direct = Buffer<vec3>(pixels), result.indirect = Buffer<vec3>(pixels);
    const double share = 1.0 / result.samples;
    parallel_blocks(pixels, 1 << 14, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i)
            result.direct[i] = vec3(direct[i] * share), result.indirect[i] = vec3(indirect[i] * share);
    });
    for (const auto& c : counts) result.counts += c;
    return result;
}

}  // namespace interreflect
