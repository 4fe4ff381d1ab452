/// Walks over a G-buffer tile by tile, in an order in which sixteen consecutive pixels are near each other.
#pragma once
#include <algorithm>
#include <array>
#include <span>

#include "data/gbuffer.h"
#include "math/parallel.h"

namespace interreflect {

inline constexpr int tile_side = 16, tile_pixels = tile_side * tile_side;

/// The pixels of one tile, 4 x 4 blocks one after the other.
class TilePixels {
  public:
    TilePixels(const GBuffer& g, const Tile& tile) : tile_(tile.index) {
        for (int block = 0; block < 16; ++block)
            for (int k = 0; k < 16; ++k) {
                const int x = tile.x0 + block % 4 * 4 + k % 4, y = tile.y0 + block / 4 * 4 + k / 4;
                if (x < tile.x1 && y < tile.y1) all_[count_++] = static_cast<std::size_t>(y) * g.width + x;
            }
        for (std::size_t i = 0; i < count_; ++i)
            if (g.hit(all_[i])) hit_[hits_++] = all_[i];
    }
    /// Those that hit a surface.
    const std::size_t* begin() const { return hit_.data(); }
    const std::size_t* end() const { return hit_.data() + hits_; }
    std::span<const std::size_t> all() const { return {all_.data(), count_}; }
    std::size_t tile() const { return tile_; }

  private:
    std::array<std::size_t, tile_pixels> all_, hit_;
    std::size_t count_ = 0, hits_ = 0, tile_;
};

/// Calls visit(pixel) for every pixel of a tile, in the same order.
template <class Visit>
void for_each_pixel(const Tile& tile, int width, const Visit& visit) {
    constexpr int block = 4;
    for (int y0 = tile.y0; y0 < tile.y1; y0 += block)
        for (int x0 = tile.x0; x0 < tile.x1; x0 += block)
            for (int y = y0; y < std::min(y0 + block, tile.y1); ++y)
                for (int x = x0; x < std::min(x0 + block, tile.x1); ++x) visit(static_cast<std::size_t>(y) * width + x);
}

inline std::size_t tile_count(const GBuffer& g, int side = tile_side) {
    const auto along = [side](int pixels) { return static_cast<std::size_t>((pixels + side - 1) / side); };
    return along(g.width) * along(g.height);
}

template <class Body>
void for_each_tile(const GBuffer& g, const Body& body) {
    parallel_tiles(g.width, g.height, tile_side, [&](const Tile& tile) { body(TilePixels(g, tile)); });
}

}  // namespace interreflect
