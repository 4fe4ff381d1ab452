#include "caches/interpolate/uncovered.h"

#include <algorithm>
#include <limits>

#include "caches/interpolate/cache_reader.h"
#include "caches/interpolate/finish.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

/// The nearest cache in space among those whose hemisphere faces the pixel's side, in the first ring of tiles around it that has
/// one, or the next one, whose caches may be nearer; no_cache where there is none.
std::uint32_t nearest_cache(const CachePlaces& places, const PixelViews::View& view) {
    const int column = static_cast<int>(view.screen.x) / places.tile, row = static_cast<int>(view.screen.y) / places.tile;
    std::uint32_t nearest = no_cache;
    float least = std::numeric_limits<float>::infinity();
    const auto look = [&](int x, int y) {
        const auto tile = static_cast<std::size_t>(y) * places.columns + x;
        for (std::uint32_t i = places.first[tile]; i < places.first[tile + 1]; ++i) {
            const vec3 away = view.position - places.position[i];
            if (glm::dot(view.normal, places.normal[i]) <= 0.0f || glm::dot(away, away) >= least) continue;
            least = glm::dot(away, away), nearest = i;
        }
    };
    int last = std::max(places.columns, places.rows);
    for (int ring = 0; ring <= last; ++ring) {
        for (int y = std::max(row - ring, 0); y <= std::min(row + ring, places.rows - 1); ++y) {
            const bool edge = y == row - ring || y == row + ring;
            for (int x = std::max(column - ring, 0); x <= std::min(column + ring, places.columns - 1); ++x)
                if (edge || x == column - ring || x == column + ring) look(x, y);
        }
        if (nearest != no_cache) last = std::min(last, ring + 1);
    }
    return nearest;
}

}  // namespace

void light_uncovered(const WeightKnobs& knobs, const ConvolvedCaches& caches, const GBuffer& gbuffer, const Scene& scene,
                     const OwnCaches& own, std::span<const Served> served, CacheLight& light) {
    std::vector<std::uint32_t> pixels;
    for (const Served& block : served) {
        pixels.insert(pixels.end(), block.uncovered.begin(), block.uncovered.end());
        light.counts.covered_pixels += block.covered;
        light.counts.cache_evaluations += block.evaluations;
    }
    light.counts.uncovered_pixels = pixels.size();
    if (knobs.uncovered == "nearest") {
        const PixelViewer viewer(gbuffer, scene, caches);
        const CacheReader reader(caches, gbuffer, scene);
        parallel_blocks(pixels.size(), PixelViews::capacity, [&](std::size_t first, std::size_t end) {
            thread_local PixelViews views;
            viewer.look(std::span<const std::uint32_t>(pixels).subspan(first, end - first), views);
            for (int i = 0; i < views.count; ++i) {
                const PixelViews::View view = views.view(i);
                const std::uint32_t cache = nearest_cache(*caches.filled->places, view);
                if (cache == no_cache) continue;
                finish_pixel(caches, view, reader.read(cache, view), light);
                pixels[first + static_cast<std::size_t>(i)] = no_cache;
            }
        });
        std::erase(pixels, no_cache);
    }
    light.counts += light_by_own_caches(own, pixels, gbuffer, scene, light);
}

}  // namespace interreflect
