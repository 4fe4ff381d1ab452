#include "caches/interpolate/splat.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "caches/interpolate/cache_reader.h"
#include "caches/interpolate/finish.h"
#include "caches/interpolate/uncovered.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr int bin_size = 64;  // pixels on a side of what one thread adds to at a time

/// Pixels that a sphere about a point of the picture reaches from where its centre is seen, at most; infinite where it reaches
/// round the eye. A sphere of angular radius b whose centre lies at an angle a off the axis ends at tan(a + b).
float reach_on_screen(const CameraRays& rays, const vec3& centre, float radius) {
    const vec3 away = centre - rays.origin;
    const float distance = glm::length(away);
    if (distance <= radius) return std::numeric_limits<float>::infinity();
    const float off = std::acos(std::clamp(glm::dot(away, rays.forward) / distance, -1.0f, 1.0f));
    const float end = off + std::asin(radius / distance);
    if (end > 1.5f) return std::numeric_limits<float>::infinity();
    return (std::tan(end) - std::tan(off)) / rays.pixel_angle() + 1.0f;
}

struct Splats {
    const CachePlaces& places;
    std::vector<float> reach;  // pixels

    /// The bin's pixels that a cache may reach: an empty tile where there are none.
    Tile reached(std::size_t cache, const Tile& bin) const {
        const vec2 at = places.screen[cache];
        const float r = reach[cache];
        const auto low = [&](float centre, int least, int most) {
            return static_cast<int>(std::clamp(std::floor(centre - r), static_cast<float>(least), static_cast<float>(most)));
        };
        const auto high = [&](float centre, int least, int most) {
            return static_cast<int>(std::clamp(std::ceil(centre + r), static_cast<float>(least), static_cast<float>(most)));
        };
        return {low(at.x, bin.x0, bin.x1), low(at.y, bin.y0, bin.y1), high(at.x, bin.x0, bin.x1), high(at.y, bin.y0, bin.y1), 0};
    }
};

/// The pixels of a bin as the splats meet them.
struct Bin {
    std::vector<PixelViews::View> view;  // row by row; `pixel` is no_cache where nothing is seen
    std::vector<CacheSum> sum;

    void look(const PixelViewer& viewer, const GBuffer& gbuffer, const Tile& bin) {
        thread_local PixelViews some;
        view.assign(static_cast<std::size_t>(bin_size) * bin_size, {});
        sum.assign(view.size(), {});
        std::vector<std::uint32_t> pixels;
        for (int y = bin.y0; y < bin.y1; ++y)
            for (int x = bin.x0; x < bin.x1; ++x)
                if (gbuffer.hit(static_cast<std::size_t>(y) * gbuffer.width + x))
                    pixels.push_back(static_cast<std::uint32_t>(y * gbuffer.width + x));
        for (std::size_t first = 0; first < pixels.size(); first += PixelViews::capacity) {
            const auto rest = std::min<std::size_t>(pixels.size() - first, PixelViews::capacity);
            viewer.look(std::span<const std::uint32_t>(pixels).subspan(first, rest), some);
            for (int i = 0; i < some.count; ++i) {
                const auto pixel = static_cast<int>(some.view[i].pixel);
                view[at(bin, pixel % gbuffer.width, pixel / gbuffer.width)] = some.view[i];
            }
        }
    }
    static std::size_t at(const Tile& bin, int x, int y) {
        return static_cast<std::size_t>(y - bin.y0) * bin_size + static_cast<std::size_t>(x - bin.x0);
    }
};

}  // namespace

CacheLight interpolate(const Splat& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own) {
    CacheLight light = empty_cache_light(gbuffer);
    const CachePlaces& places = *caches->filled->places;
    const CacheWeights weights(technique, places, technique.weight == "world");
    const PixelViewer viewer(gbuffer, scene, *caches);
    const CacheReader reader(*caches, gbuffer, scene);
    const CameraRays rays(gbuffer.camera, gbuffer.width, gbuffer.height);
    Splats splats{places, std::vector<float>(places.size())};
    for (std::size_t i = 0; i < places.size(); ++i)
        splats.reach[i] = std::min(weights.screen_radius(), reach_on_screen(rays, places.position[i], weights.world_radius(i)));
    const auto columns = static_cast<std::size_t>((gbuffer.width + bin_size - 1) / bin_size);
    std::vector<std::uint64_t> evaluations(columns * static_cast<std::size_t>((gbuffer.height + bin_size - 1) / bin_size));
    parallel_tiles(gbuffer.width, gbuffer.height, bin_size, [&](const Tile& bin) {
        thread_local Bin of;
        of.look(viewer, gbuffer, bin);
        for (std::size_t cache = 0; cache < places.size(); ++cache) {
            const Tile reached = splats.reached(cache, bin);
            for (int y = reached.y0; y < reached.y1; ++y)
                for (int x = reached.x0; x < reached.x1; ++x) {
                    const std::size_t i = Bin::at(bin, x, y);
                    if (of.view[i].pixel == no_cache) continue;
                    const float weight = weights.weight(cache, of.view[i]);
                    if (weight <= 0.0f) continue;
                    of.sum[i].add(reader.read(cache, of.view[i]), weight);
                    ++evaluations[bin.index];
                }
        }
        for (std::size_t i = 0; i < of.view.size(); ++i)
            if (of.sum[i].weight > 0.0f) finish_pixel(*caches, of.view[i], of.sum[i], light);
    });
    for (const auto one : evaluations) light.counts.cache_evaluations += one;
    light_uncovered(technique, *caches, gbuffer, scene, own, light);
    return light;
}

}  // namespace interreflect
