#include "reference/path_tracing.h"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "reference/tile_tracer.h"
#include "visibility/trace_gbuffer.h"

namespace interreflect {
namespace {

constexpr int samples_a_pass = 8;  // between two looks at the clock and at Ctrl-C
using Clock = std::chrono::steady_clock;

void check(const PathTracingSettings& s) {
    const int least = s.pixel == PixelFilter::centre && !s.milliseconds ? 0 : 1;
    if (s.samples < least)
        throw std::invalid_argument("samples must be at least " + std::to_string(least) + ", got " + std::to_string(s.samples));
    if (s.bounces && *s.bounces < 0)
        throw std::invalid_argument("bounces must not be negative, got " + std::to_string(*s.bounces));
    if (s.milliseconds && !(*s.milliseconds > 0.0)) throw std::invalid_argument("milliseconds must be positive");
    if (s.pattern < 1 || s.pattern > tracing_tile)
        throw std::invalid_argument("pattern must lie in [1, " + std::to_string(tracing_tile) + "], got " +
                                    std::to_string(s.pattern));
}

/// Sums over passes: thousands of samples of a float lose what a double keeps.
struct Sums {
    Buffer<glm::dvec3> direct, indirect;
    explicit Sums(std::size_t pixels) : direct(pixels), indirect(pixels) {}
};

/// Calls body(pixel of the picture, pixel of the tile).
template <class Body>
void for_each_pixel(const Tile& tile, int width, const Body& body) {
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x)
            body(static_cast<std::size_t>(y) * width + x, static_cast<std::size_t>((y - tile.y0) * tracing_tile + x - tile.x0));
}

/// One pass that is the only one: sums become means at once.
void store_means(const TileTracer& traced, const Tile& tile, PathTraced& result) {
    const float share = result.samples == 0 ? 0.0f : 1.0f / static_cast<float>(result.samples);
    for_each_pixel(tile, result.width, [&](std::size_t pixel, std::size_t in_tile) {
        result.direct[pixel] = traced.certain()[in_tile] + traced.direct()[in_tile] * share;
        result.indirect[pixel] = traced.indirect()[in_tile] * share;
    });
}

void add_sums(const TileTracer& traced, const Tile& tile, bool first, int width, Sums& sums) {
    for_each_pixel(tile, width, [&](std::size_t pixel, std::size_t in_tile) {
        if (first) sums.direct[pixel] = sums.indirect[pixel] = glm::dvec3(0);
        sums.direct[pixel] += glm::dvec3(traced.direct()[in_tile]);
        sums.indirect[pixel] += glm::dvec3(traced.indirect()[in_tile]);
    });
}

void store_means(const Sums& sums, PathTraced& result) {
    const double share = 1.0 / result.samples;
    parallel_blocks(result.direct.size(), 1 << 14, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i) {
            const vec3 certain = result.certain.empty() ? vec3(0) : result.certain[i];
            result.direct[i] = certain + vec3(sums.direct[i] * share);
            result.indirect[i] = vec3(sums.indirect[i] * share);
        }
    });
}

}  // namespace

PathTraced path_trace(const Scene& scene, const Intersector& intersector, const LightSampler& lights, const Camera& camera,
                      int width, int height, const PathTracingSettings& settings) {
    check(settings);
    check_view(camera, width, height);
    const auto begin = Clock::now();
    const Integrand integrand{scene,
                              intersector,
                              lights,
                              CameraRays(camera, width, height),
                              settings.bounces.value_or(Integrand::every_vertex),
                              settings.pixel,
                              settings.pattern,
                              settings.seed,
                              SurfaceKernel(scene)};
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    PathTraced result;
    result.width = width, result.height = height;
    result.direct = Buffer<vec3>(pixels), result.indirect = Buffer<vec3>(pixels);
    if (settings.pixel == PixelFilter::centre) result.certain = Buffer<vec3>(pixels);
    oneapi::tbb::enumerable_thread_specific<TileTracer> tracers([&] { return TileTracer(integrand); });
    oneapi::tbb::enumerable_thread_specific<Counts> counts;
    const bool timed = settings.milliseconds.has_value();
    const bool one_pass = !timed && settings.samples <= samples_a_pass;
    std::optional<Sums> sums;
    if (!one_pass) sums.emplace(pixels);
    for (bool done = false; !done;) {
        const int first = result.samples;
        result.samples = timed ? first + 1 : std::min(first + samples_a_pass, settings.samples);
        parallel_tiles(width, height, tracing_tile, [&](const Tile& tile) {
            TileTracer& tracer = tracers.local();
            tracer.trace(tile, first, result.samples);
            sums ? add_sums(tracer, tile, first == 0, width, *sums) : store_means(tracer, tile, result);
            if (first == 0 && !result.certain.empty())
                for_each_pixel(tile, width, [&](std::size_t pixel, std::size_t in_tile) {
                    result.certain[pixel] = tracer.certain()[in_tile];
                });
            counts.local() += tracer.counts();
        });
        const std::chrono::duration<double, std::milli> spent = Clock::now() - begin;
        done = timed ? spent.count() >= *settings.milliseconds : result.samples == settings.samples;
    }
    if (sums) store_means(*sums, result);
    for (const auto& c : counts) result.counts += c;
    return result;
}

}  // namespace interreflect
