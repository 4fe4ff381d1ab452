/// Clusters of all tiles: keys, groups, counts, and one cache each, as in clustered shading [Olsson et al. 2012], tile by tile.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
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

/// The keys of a tile's pixels, row by row. Keys: fill(pixels, key) writes them, with room, no_cache where nothing was hit.
template <class Keys>
std::span<const std::uint32_t> keys_of(const TilePixels& pixels, const Keys& keys) {
    thread_local std::vector<std::uint32_t> key;
    key.resize(with_room(pixels.count()));
    keys.fill(pixels, key.data());
    return {key.data(), pixels.count()};
}

struct ClusterEstimate {
    double count = 0, error = 0;  // error: standard, relative; 0 where every tile was looked at
};

/// How many clusters tiles of a size make, estimated from at most 128 of them spread over the picture.
template <class Keys>
ClusterEstimate estimate_clusters(const GBuffer& gbuffer, int tile, const Keys& keys) {
    constexpr std::size_t most = 128;
    const CachePlaces tiles = tiles_of(gbuffer, tile);
    const std::size_t all = static_cast<std::size_t>(tiles.columns) * tiles.rows, looked_at = std::min(all, most);
    std::vector<double> found(looked_at);
    parallel_pieces(looked_at, [&](std::size_t k) {
        thread_local TilePixels pixels;
        thread_local TileClusters clusters;
        // The golden ratio's multiples are spread evenly and in step with no row.
        const double place = static_cast<double>(k) * 0.6180339887498949;
        const auto i = all <= most ? k : static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(all));
        pixels.load(gbuffer, tile_at(tiles, i));
        found[k] = static_cast<double>(clusters.count(keys_of(pixels, keys)));
    });
    double sum = 0, squares = 0;
    for (const double one : found) sum += one, squares += one * one;
    if (sum == 0.0) return {};
    const double n = static_cast<double>(looked_at), unseen = 1.0 - n / static_cast<double>(all);
    return {sum / n * static_cast<double>(all), std::sqrt(unseen * std::max(n * squares / (sum * sum) - 1.0, 0.0) / n)};
}

/// A tile's side whose clusters are near `target`: fewer clusters for larger tiles, by a power of their side that is learned on
/// the way, is what the search builds on. make(tile) are the keys for tiles of that size.
template <class MakeKeys>
int find_tile(const GBuffer& gbuffer, int target, const MakeKeys& make) {
    constexpr int most_probes = 8;
    constexpr double near_enough = 0.02;
    int below = 0, above = std::max(gbuffer.width, gbuffer.height) + 1;  // sides with too many clusters, and with too few
    double side = std::sqrt(4.0 * static_cast<double>(gbuffer.pixels()) / target), power = 1.5;
    int best = 1, last = 0;
    double least = std::numeric_limits<double>::infinity(), last_excess = 0;
    for (int probe = 0; probe < most_probes && above - below > 1; ++probe) {
        const int tile = static_cast<int>(std::clamp(std::round(side), below + 1.0, above - 1.0));
        const ClusterEstimate found = estimate_clusters(gbuffer, tile, make(tile));
        const double excess = std::log(std::max(found.count, 0.5) / target);
        if (std::fabs(excess) < least) least = std::fabs(excess), best = tile;
        if (least < std::max(near_enough, 0.5 * found.error)) break;  // nearer ones would be so by chance
        (excess > 0.0 ? below : above) = tile;
        if (last > 0) power = std::clamp((last_excess - excess) / std::log(static_cast<double>(tile) / last), 0.5, 2.5);
        last = tile, last_excess = excess;
        side = tile * std::exp(excess / power);
    }
    return best;
}

/// One cache for every cluster of a picture's tiles.
template <class Keys>
CachePlaces cluster_tiles(const GBuffer& gbuffer, int tile, const Keys& keys) {
    constexpr std::size_t at_once = 8;
    CachePlaces places = tiles_of(gbuffer, tile);
    const std::size_t all = static_cast<std::size_t>(places.columns) * places.rows;
    places.cluster = Buffer<std::uint32_t>(gbuffer.pixels());
    places.first.assign(all + 1, 0);
    struct Chosen {
        std::uint32_t pixel, members;
    };
    std::vector<std::vector<Chosen>> chosen((all + at_once - 1) / at_once);
    parallel_blocks(all, at_once, [&](std::size_t begin, std::size_t end) {
        thread_local TilePixels pixels;
        thread_local TileClusters clusters;
        for (std::size_t i = begin; i < end; ++i) {
            const Tile at = tile_at(places, i);
            pixels.load(gbuffer, at), pixels.load_positions(gbuffer);
            clusters.group(pixels, keys_of(pixels, keys));
            clusters.choose_pixels(pixels);
            for (const auto& cluster : clusters.clusters)
                chosen[begin / at_once].push_back(
                    {static_cast<std::uint32_t>(pixels.in_picture(cluster.pixel)), cluster.members});
            places.first[i + 1] = static_cast<std::uint32_t>(clusters.clusters.size());
            const std::uint32_t* slot = clusters.slot.data();
            for (int y = at.y0; y < at.y1; ++y, slot += at.x1 - at.x0)
                std::copy_n(slot, at.x1 - at.x0, places.cluster.data() + static_cast<std::size_t>(y) * places.width + at.x0);
        }
    });
    std::partial_sum(places.first.begin(), places.first.end(), places.first.begin());
    std::vector<std::uint32_t> pixels(places.first[all]), members(places.first[all]);
    parallel_blocks(all, at_once, [&](std::size_t begin, std::size_t end) {
        std::size_t k = places.first[begin];
        for (const Chosen& one : chosen[begin / at_once]) pixels[k] = one.pixel, members[k++] = one.members;
        for (std::size_t i = begin; i < end; ++i) {
            const Tile at = tile_at(places, i);
            const std::uint32_t first = places.first[i];
            for (int y = at.y0; y < at.y1; ++y) {
                std::uint32_t* const row = places.cluster.data() + static_cast<std::size_t>(y) * places.width;
                for (int x = at.x0; x < at.x1; ++x) row[x] += row[x] == TileClusters::none ? 0 : first;
            }
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
