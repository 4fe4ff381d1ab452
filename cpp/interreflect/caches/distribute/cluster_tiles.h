/// Clusters of all tiles: keys, groups, counts, and one cache each, as in clustered shading [Olsson et al. 2012], tile by tile.
#pragma once
#include <cmath>
#include <numeric>
#include <vector>

#include "caches/distribute/place.h"
#include "caches/distribute/tile_clusters.h"
#include "caches/distribute/tile_knobs.h"
#include "math/parallel.h"

namespace interreflect {

/// Tile i of a distribution, row by row.
inline Tile tile_at(const CachePlaces& places, std::size_t i) {
    const int x = static_cast<int>(i % static_cast<std::size_t>(places.columns)) * places.tile;
    const int y = static_cast<int>(i / static_cast<std::size_t>(places.columns)) * places.tile;
    return {x, y, std::min(x + places.tile, places.width), std::min(y + places.tile, places.height), i};
}

/// How many clusters tiles of a size make, estimated from at most 512 of them spread over the picture.
/// Keys: of(gbuffer, tile) is a function from a pixel of that tile to its key.
template <class Keys>
double count_clusters(const GBuffer& gbuffer, int tile, const Keys& keys) {
    constexpr std::size_t most = 512;
    const CachePlaces tiles = tiles_of(gbuffer, tile);
    const std::size_t all = static_cast<std::size_t>(tiles.columns) * tiles.rows, looked_at = std::min(all, most);
    std::vector<std::size_t> found(looked_at);
    parallel_pieces(looked_at, [&](std::size_t k) {
        thread_local TileClusters clusters;
        // The golden ratio's multiples are spread evenly and in step with no row.
        const double place = static_cast<double>(k) * 0.6180339887498949;
        const auto i = all <= most ? k : static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(all));
        const Tile at = tile_at(tiles, i);
        clusters.group(gbuffer, at, keys.of(gbuffer, at));
        found[k] = clusters.clusters.size();
    });
    const auto sum = static_cast<double>(std::accumulate(found.begin(), found.end(), std::size_t{0}));
    return looked_at == 0 ? 0.0 : sum * static_cast<double>(all) / static_cast<double>(looked_at);
}

/// The tile's side whose clusters come nearest to `target` in ratio; fewer clusters for larger tiles is what the search builds
/// on. make(tile) are the keys for tiles of that size.
template <class MakeKeys>
int find_tile(const GBuffer& gbuffer, int target, const MakeKeys& make) {
    const int largest = std::max(gbuffer.width, gbuffer.height);
    int below = 1, above = largest;  // sides with too many clusters, and with too few
    double many = -1, few = -1;      // how many those are; -1: not counted
    double side = std::sqrt(1.5 * static_cast<double>(gbuffer.pixels()) / target);
    while (above - below > 1) {
        const int middle = std::clamp(static_cast<int>(std::lround(side)), below + 1, above - 1);
        const double count = count_clusters(gbuffer, middle, make(middle));
        (count > target ? below : above) = middle;
        (count > target ? many : few) = count;
        side = count > 0 ? middle * std::sqrt(count / target) : 0.5 * (below + above);
    }
    if (many < 0) many = count_clusters(gbuffer, below, make(below));
    if (few < 0) few = count_clusters(gbuffer, above, make(above));
    return few <= 0 || many / target < target / few ? below : above;
}

/// One cache for every cluster of a picture's tiles.
template <class Keys>
CachePlaces cluster_tiles(const GBuffer& gbuffer, int tile, const Keys& keys) {
    CachePlaces places = tiles_of(gbuffer, tile);
    const std::size_t all = static_cast<std::size_t>(places.columns) * places.rows;
    places.cluster = Buffer<std::uint32_t>(gbuffer.pixels());
    places.first.assign(all + 1, 0);
    struct Chosen {
        std::uint32_t pixel, members;
    };
    std::vector<std::vector<Chosen>> chosen(all);
    parallel_pieces(all, [&](std::size_t i) {
        thread_local TileClusters clusters;
        const Tile at = tile_at(places, i);
        clusters.group(gbuffer, at, keys.of(gbuffer, at));
        clusters.choose_pixels(gbuffer, at);
        for (const auto& cluster : clusters.clusters) chosen[i].push_back({cluster.pixel, cluster.members});
        const std::uint32_t* slot = clusters.slot.data();
        for (int y = at.y0; y < at.y1; ++y)
            for (int x = at.x0; x < at.x1; ++x) places.cluster[static_cast<std::size_t>(y) * places.width + x] = *slot++;
    });
    for (std::size_t i = 0; i < all; ++i) places.first[i + 1] = places.first[i] + static_cast<std::uint32_t>(chosen[i].size());
    std::vector<std::uint32_t> pixels(places.first[all]), members(places.first[all]);
    parallel_pieces(all, [&](std::size_t i) {
        const std::uint32_t first = places.first[i];
        for (std::size_t k = 0; k < chosen[i].size(); ++k)
            pixels[first + k] = chosen[i][k].pixel, members[first + k] = chosen[i][k].members;
        const Tile at = tile_at(places, i);
        for (int y = at.y0; y < at.y1; ++y)
            for (int x = at.x0; x < at.x1; ++x) {
                auto& cluster = places.cluster[static_cast<std::size_t>(y) * places.width + x];
                if (cluster != TileClusters::none) cluster += first;
            }
    });
    place_caches(gbuffer, pixels, members, places);
    places.counts.clusters = pixels.size();
    return places;
}

/// As the knobs say: tiles of that side, or of the side that makes as many caches as are wanted.
template <class MakeKeys>
CachePlaces cluster_picture(const GBuffer& gbuffer, const TileKnobs& knobs, const MakeKeys& make) {
    const int tile = knobs.caches > 0 ? find_tile(gbuffer, knobs.caches, make) : knobs.tile;
    return cluster_tiles(gbuffer, tile, make(tile));
}

}  // namespace interreflect
