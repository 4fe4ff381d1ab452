#include "caches/interpolate/gather.h"

#include <algorithm>
#include <vector>

#include "caches/interpolate/cache_reader.h"
#include "caches/interpolate/finish.h"
#include "caches/interpolate/uncovered.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr int block_size = 16;
static_assert(block_size * block_size <= PixelViews::capacity);

/// The caches that are seen within `radius` pixels of a block's pixels, in ascending order.
void caches_near(const CachePlaces& places, const Tile& block, float radius, std::vector<std::uint32_t>& near) {
    near.clear();
    const vec2 lower(block.x0, block.y0), upper(block.x1, block.y1);
    const auto tile_of = [&](float at, int most) {
        return std::clamp(static_cast<int>(std::floor(at / static_cast<float>(places.tile))), 0, most - 1);
    };
    const int x0 = tile_of(lower.x - radius, places.columns), x1 = tile_of(upper.x + radius, places.columns);
    const int y0 = tile_of(lower.y - radius, places.rows), y1 = tile_of(upper.y + radius, places.rows);
    for (int y = y0; y <= y1; ++y) {
        const auto row = static_cast<std::size_t>(y) * places.columns;
        for (std::uint32_t i = places.first[row + x0]; i < places.first[row + x1 + 1]; ++i) {
            const vec2 aside = places.screen[i] - glm::clamp(places.screen[i], lower, upper);
            if (glm::dot(aside, aside) < radius * radius) near.push_back(i);
        }
    }
}

}  // namespace

CacheLight interpolate(const Gather& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own) {
    CacheLight light = empty_cache_light(gbuffer);
    const CachePlaces& places = *caches->filled->places;
    const CacheWeights weights(technique, places, false);
    const PixelViewer viewer(gbuffer, scene, *caches);
    const CacheReader reader(*caches, gbuffer, scene);
    const auto columns = static_cast<std::size_t>((gbuffer.width + block_size - 1) / block_size);
    std::vector<std::uint64_t> evaluations(columns * static_cast<std::size_t>((gbuffer.height + block_size - 1) / block_size));
    parallel_tiles(gbuffer.width, gbuffer.height, block_size, [&](const Tile& block) {
        thread_local PixelViews views;
        thread_local std::vector<std::uint32_t> near, pixels;
        pixels.clear();
        for (int y = block.y0; y < block.y1; ++y)
            for (int x = block.x0; x < block.x1; ++x) {
                const auto pixel = static_cast<std::uint32_t>(y * gbuffer.width + x);
                if (gbuffer.hit(pixel)) pixels.push_back(pixel);
            }
        if (pixels.empty()) return;
        viewer.look(pixels, views);
        caches_near(places, block, weights.screen_radius(), near);
        for (int i = 0; i < views.count; ++i) {
            const auto& view = views.view[i];
            CacheSum sum;
            for (const std::uint32_t cache : near) {
                const float weight = weights.weight(cache, view);
                if (weight <= 0.0f) continue;
                sum.add(reader.read(cache, view), weight);
                ++evaluations[block.index];
            }
            if (sum.weight > 0.0f) finish_pixel(*caches, view, sum, light);
        }
    });
    for (const auto one : evaluations) light.counts.cache_evaluations += one;
    light_uncovered(technique, *caches, gbuffer, scene, own, light);
    return light;
}

}  // namespace interreflect
