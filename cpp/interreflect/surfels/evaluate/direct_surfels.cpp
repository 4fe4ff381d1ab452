#include <algorithm>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "math/parallel.h"
#include "surfels/evaluate/beam.h"
#include "surfels/evaluate/cache_finder.h"
#include "surfels/evaluate/direct_links.h"
#include "surfels/link/sampled_surfels.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16;  // pixels
static_assert(tile_size <= NearCaches::length);

/// A pixel of a tile that takes part of its light from a cache.
struct Read {
    std::uint32_t cache, place;  // place: within the tile
    float weight;
};

/// By cache, so that each looks once a tile.
std::vector<Read> reads_of(const Tile& tile, const CacheFinder& finder, int width) {
    std::vector<Read> reads;
    NearCaches near;
    for (int y = tile.y0; y < tile.y1; ++y) {
        finder.find(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(tile.x0),
                    tile.x1 - tile.x0, near);
        for (int x = 0; x < tile.x1 - tile.x0; ++x)
            for (int slot = 0; slot < near.slots; ++slot)
                if (near.weight[slot][x] > 0.0f)
                    reads.push_back(
                        {near.cache[slot][x], static_cast<std::uint32_t>((y - tile.y0) * tile_size + x), near.weight[slot][x]});
    }
    std::ranges::stable_sort(reads, {}, &Read::cache);
    return reads;
}

}  // namespace

SurfelLight evaluate(const DirectLinks&, const AllSurfels& links, const CacheSites& sites, const ClusteredSurfels& surfels,
                     const NodeLight& light, const GBuffer& gbuffer, const Scene& scene, const Intersector& intersector,
                     std::uint32_t seed) {
    if (light.size() != surfels.tree.nodes()) throw std::invalid_argument("DirectLinks: light of another number of surfels");
    SurfelLight made = empty_surfel_light(gbuffer);
    const CacheFinder finder(sites, gbuffer);
    const SampledSurfels sampled(links, surfels, light, scene, intersector, seed);
    std::vector<Counts> counts(tile_count(gbuffer.width, gbuffer.height, tile_size));
    parallel_tiles(gbuffer.width, gbuffer.height, tile_size, [&](const Tile& tile) {
        Counts& mine = counts[tile.index];
        const std::vector<Read> reads = reads_of(tile, finder, gbuffer.width);
        std::vector<Reflected> sums(tile_size * tile_size);
        std::vector<std::optional<PixelSurface>> surfaces(sums.size());
        const auto pixel_at = [&](std::uint32_t place) {
            const int x = tile.x0 + static_cast<int>(place % tile_size), y = tile.y0 + static_cast<int>(place / tile_size);
            return static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width) + static_cast<std::size_t>(x);
        };
        for (const Read& read : reads)
            if (!surfaces[read.place]) surfaces[read.place].emplace(gbuffer, scene, pixel_at(read.place));
        SampledCache memory(surfels.surfels.size());
        for (auto first = reads.begin(); first != reads.end();) {
            const auto last = std::find_if(first, reads.end(), [&](const Read& read) { return read.cache != first->cache; });
            sampled.each_beam(sites, first->cache, memory, mine,
                              [&](const vec3& direction, const vec3& radiance, float solid_angle) {
                                  const Beam beam{direction, radiance * solid_angle};
                                  for (auto read = first; read != last; ++read)
                                      sums[read->place].add(*surfaces[read->place], beam, read->weight);
                              });
            first = last;
        }
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const auto place = static_cast<std::uint32_t>((y - tile.y0) * tile_size + x - tile.x0);
                const std::size_t pixel = pixel_at(place);
                made.gathered.irradiance[pixel] = sums[place].irradiance;
                made.glossy.radiance[pixel] = sums[place].glossy;
                if (gbuffer.hit(pixel)) ++(surfaces[place] ? mine.covered_pixels : mine.uncovered_pixels);
            }
    });
    for (const Counts& one : counts) made.counts += one;
    return made;
}

}  // namespace interreflect
