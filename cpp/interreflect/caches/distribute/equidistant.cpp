#include "caches/distribute/equidistant.h"

#include "caches/distribute/cluster_tiles.h"

namespace interreflect {
namespace {

/// The pixel in a tile's middle.
std::size_t middle_of(const GBuffer& gbuffer, const Tile& tile) {
    return static_cast<std::size_t>((tile.y0 + tile.y1) / 2) * gbuffer.width + (tile.x0 + tile.x1) / 2;
}

/// A side whose tiles with a surface in the middle are as many as are wanted.
int find_side(const GBuffer& gbuffer, int target) {
    const auto count = [&](int side) {
        const CachePlaces tiles = tiles_of(gbuffer, side);
        int found = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(tiles.columns) * tiles.rows; ++i)
            found += gbuffer.hit(middle_of(gbuffer, tile_at(tiles, i))) ? 1 : 0;
        return found;
    };
    int below = 1, above = std::max(gbuffer.width, gbuffer.height);
    while (above - below > 1) {
        const int middle = (below + above) / 2;
        (count(middle) > target ? below : above) = middle;
    }
    const double many = count(below), few = count(above);
    return few <= 0 || many / target < target / few ? below : above;
}

}  // namespace

CachePlaces distribute(const Equidistant& technique, const GBuffer& gbuffer, const Scene&, const CachePlaces*) {
    CachePlaces places = tiles_of(gbuffer, technique.caches > 0 ? find_side(gbuffer, technique.caches) : technique.tile);
    places.cluster = Buffer<std::uint32_t>(gbuffer.pixels());
    std::vector<std::uint32_t> pixels, members;
    for (std::size_t i = 0; i < static_cast<std::size_t>(places.columns) * places.rows; ++i) {
        const Tile tile = tile_at(places, i);
        places.first.push_back(static_cast<std::uint32_t>(pixels.size()));
        const std::size_t middle = middle_of(gbuffer, tile);
        const bool stands = gbuffer.hit(middle);
        std::uint32_t seen = 0;
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * gbuffer.width + x;
                places.cluster[pixel] = stands && gbuffer.hit(pixel) ? places.first.back() : no_cache;
                seen += gbuffer.hit(pixel) ? 1 : 0;
            }
        if (stands) pixels.push_back(static_cast<std::uint32_t>(middle)), members.push_back(seen);
    }
    places.first.push_back(static_cast<std::uint32_t>(pixels.size()));
    place_caches(gbuffer, pixels, members, places);
    places.counts.clusters = pixels.size();
    return places;
}

}  // namespace interreflect
