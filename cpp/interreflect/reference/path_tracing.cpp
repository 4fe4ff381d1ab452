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
    if (s.samples < 1) throw std::invalid_argument("samples must be at least 1, got " + std::to_string(s.samples));
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

/// Adds a tile to the sums of the passes before; on the last pass it turns them into means.
void store(const TileTracer& traced, const Tile& tile, bool first, bool last, Sums* sums, PathTraced& result) {
    const double share = 1.0 / result.samples;
    const auto put = [&](const std::vector<vec3>& one, Buffer<glm::dvec3>* sum, Buffer<vec3>& mean) {
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * result.width + x;
                glm::dvec3 total(one[(y - tile.y0) * tracing_tile + x - tile.x0]);
                if (!first) total += (*sum)[pixel];
                if (sum != nullptr) (*sum)[pixel] = total;
                if (last) mean[pixel] = vec3(total * share);
            }
    };
    put(traced.direct(), sums == nullptr ? nullptr : &sums->direct, result.direct);
    put(traced.indirect(), sums == nullptr ? nullptr : &sums->indirect, result.indirect);
}

void divide(const Sums& sums, PathTraced& result) {
    const double share = 1.0 / result.samples;
    parallel_blocks(result.direct.size(), 1 << 14, [&](std::size_t from, std::size_t to) {
        for (std::size_t i = from; i < to; ++i)
            result.direct[i] = vec3(sums.direct[i] * share), result.indirect[i] = vec3(sums.indirect[i] * share);
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
                              settings.seed};
    const std::size_t pixels = static_cast<std::size_t>(width) * height;
    PathTraced result;
    result.width = width, result.height = height;
    result.direct = Buffer<vec3>(pixels), result.indirect = Buffer<vec3>(pixels);
    oneapi::tbb::enumerable_thread_specific<TileTracer> tracers([&] { return TileTracer(integrand); });
    oneapi::tbb::enumerable_thread_specific<Counts> counts;
    const bool timed = settings.milliseconds.has_value();
    const bool one_pass = !timed && settings.samples <= samples_a_pass;
    std::optional<Sums> sums;
    if (!one_pass) sums.emplace(pixels);
    for (bool done = false; !done;) {
        const int first = result.samples;
        result.samples = timed ? first + 1 : std::min(first + samples_a_pass, settings.samples);
        const bool last = !timed && result.samples == settings.samples;
        parallel_tiles(width, height, tracing_tile, [&](const Tile& tile) {
            TileTracer& tracer = tracers.local();
            tracer.trace(tile, first, result.samples);
            store(tracer, tile, first == 0, last, sums ? &*sums : nullptr, result);
            counts.local() += tracer.counts();
        });
        const std::chrono::duration<double, std::milli> spent = Clock::now() - begin;
        done = last || (timed && spent.count() >= *settings.milliseconds);
    }
    if (timed) divide(*sums, result);
    for (const auto& c : counts) result.counts += c;
    return result;
}

}  // namespace interreflect
