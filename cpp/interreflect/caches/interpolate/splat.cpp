#include "caches/interpolate/splat.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "caches/interpolate/finish.h"
#include "caches/interpolate/sum_caches.h"
#include "caches/interpolate/uncovered.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr int block_size = PixelViews::block_size;
constexpr int bin_size = 4 * block_size;  // pixels on a side of what one thread adds to at a time

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

    bool reach_into(std::size_t cache, const Tile& tile) const {
        const vec2 lower(tile.x0, tile.y0), upper(tile.x1, tile.y1), at = places.screen[cache];
        const vec2 aside = at - glm::clamp(at, lower, upper);
        return glm::dot(aside, aside) < reach[cache] * reach[cache];
    }
};

/// Pixels, and the caches that are splatted onto them.
struct Block {
    PixelViews views;
    Tile tile;
    std::vector<std::uint32_t> splats;
};

/// Those of a bin that see something.
std::size_t look(const PixelViewer& viewer, const Tile& bin, std::vector<Block>& blocks, CacheLight& light) {
    std::size_t count = 0;
    for (int y = bin.y0; y < bin.y1; y += block_size)
        for (int x = bin.x0; x < bin.x1; x += block_size) {
            if (count == blocks.size()) blocks.emplace_back();
            Block& block = blocks[count];
            block.tile = {x, y, std::min(x + block_size, bin.x1), std::min(y + block_size, bin.y1), 0};
            viewer.look(block.tile, block.views);
            clear_unseen(block.tile, block.views.count, light);
            block.splats.clear();
            if (block.views.count > 0) ++count;
        }
    return count;
}

}  // namespace

CacheLight interpolate(const Splat& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own) {
    CacheLight light = empty_cache_light(gbuffer);
    const CachePlaces& places = *caches->filled->places;
    const CacheWeights weights(technique, places, technique.weight == "world");
    const PixelViewer viewer(gbuffer, scene, *caches);
    const CacheSummer summer(*caches, weights, gbuffer, scene);
    const CameraRays rays(gbuffer.camera, gbuffer.width, gbuffer.height);
    Splats splats{places, std::vector<float>(places.size())};
    for (std::size_t i = 0; i < places.size(); ++i)
        splats.reach[i] = std::min(weights.screen_radius(), reach_on_screen(rays, places.position[i], weights.world_radius(i)));
    std::vector<Served> served(tile_count(gbuffer.width, gbuffer.height, bin_size));
    parallel_tiles(gbuffer.width, gbuffer.height, bin_size, [&](const Tile& bin) {
        thread_local std::vector<Block> blocks;
        thread_local CacheSums sums;
        const std::size_t count = look(viewer, bin, blocks, light);
        for (std::size_t cache = 0; cache < places.size(); ++cache) {
            if (!splats.reach_into(cache, bin)) continue;
            for (std::size_t i = 0; i < count; ++i)
                if (splats.reach_into(cache, blocks[i].tile)) blocks[i].splats.push_back(static_cast<std::uint32_t>(cache));
        }
        for (std::size_t i = 0; i < count; ++i) {
            served[bin.index].evaluations += summer.sum(blocks[i].splats, blocks[i].views, sums);
            finish_pixels(*caches, blocks[i].views, sums, light, served[bin.index]);
        }
    });
    light_uncovered(technique, *caches, gbuffer, scene, own, served, light);
    return light;
}

}  // namespace interreflect
