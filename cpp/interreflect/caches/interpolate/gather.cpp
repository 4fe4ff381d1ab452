#include "caches/interpolate/gather.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "caches/interpolate/finish.h"
#include "caches/interpolate/sum_caches.h"
#include "caches/interpolate/uncovered.h"
#include "math/parallel.h"
#include "visibility/sphere_hierarchy.h"

namespace interreflect {
namespace {

constexpr int block_size = PixelViews::block_size;

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

/// Spheres in which caches count.
void build(const CachePlaces& places, const CacheWeights& weights, std::optional<SphereHierarchy>& hierarchy) {
    std::vector<float> radii(places.size());
    for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = weights.world_radius(i);
    hierarchy.emplace(std::span(places.position.data(), places.size()), radii);
}

/// The caches whose spheres reach the ball about the pixels' surfaces, in ascending order.
void caches_near(const SphereHierarchy& hierarchy, const PixelViews& views, std::vector<std::uint32_t>& near) {
    vec3 lower(std::numeric_limits<float>::infinity()), upper(-std::numeric_limits<float>::infinity());
    for (int i = 0; i < views.count; ++i) {
        const vec3 position(views.position[0][i], views.position[1][i], views.position[2][i]);
        lower = glm::min(lower, position), upper = glm::max(upper, position);
    }
    hierarchy.reach(0.5f * (lower + upper), 0.5f * glm::length(upper - lower), near);
}

}  // namespace

CacheLight interpolate(const Gather& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own) {
    CacheLight light = empty_cache_light(gbuffer);
    const CachePlaces& places = *caches->filled->places;
    const CacheWeights weights(technique, places, false);
    const PixelViewer viewer(gbuffer, scene, *caches);
    const CacheSummer summer(*caches, weights, gbuffer, scene);
    std::optional<SphereHierarchy> hierarchy;
    if (technique.search == "hierarchy") build(places, weights, hierarchy);
    std::vector<Served> served(tile_count(gbuffer.width, gbuffer.height, block_size));
    parallel_tiles(gbuffer.width, gbuffer.height, block_size, [&](const Tile& block) {
        thread_local PixelViews views;
        thread_local CacheSums sums;
        thread_local std::vector<std::uint32_t> near;
        viewer.look(block, views);
        clear_unseen(block, views.count, light);
        if (views.count == 0) return;
        if (hierarchy)
            caches_near(*hierarchy, views, near);
        else
            caches_near(places, block, weights.screen_radius(), near);
        served[block.index].evaluations = summer.sum(near, views, sums);
        finish_pixels(*caches, views, sums, light, served[block.index]);
    });
    light_uncovered(technique, *caches, gbuffer, scene, own, served, light);
    return light;
}

}  // namespace interreflect
