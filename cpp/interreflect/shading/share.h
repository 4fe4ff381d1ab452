/// Share: which part of a pixel's work does the pixel do itself, and how is the rest taken from its neighbours?
///
/// Pixels stand in blocks; a pixel's place in its block is its *phase*. A stage splits a pixel's work (cones, samples) among the
/// phases: each pixel writes the sum over its own part, and `merge` puts together what a whole pixel would have gathered.
/// Exact counterpart: EveryPixel.
#pragma once
#include <array>
#include <span>
#include <variant>

#include "shading/share/every_pixel.h"
#include "shading/share/interleaved.h"

namespace interreflect {
using Share = std::variant<EveryPixel, Interleaved>;

/// The blocks of a way to share: `width` x `height` pixels.
struct Block {
    int width = 1, height = 1;

    int phases() const { return width * height; }
    int phase(int x, int y) const { return x % width + width * (y % height); }
};
inline Block block_of(const EveryPixel&) { return {}; }
inline Block block_of(const Interleaved& share) { return {share.width, share.height}; }
inline Block block_of(const Share& share) {
    return std::visit([](const auto& one) { return block_of(one); }, share);
}

/// What whole pixels would have gathered: calls visit(first, values) for rows of pixels, in parallel, until all were visited.
/// `partial`: each pixel's sum over its own part of the work; `weights`: the share of the whole that each phase does; they sum
/// to 1. A uniform field comes out as it went in.
template <class Visit>
void merge(const Share& share, const GBuffer& gbuffer, std::span<const float> weights, const Buffer<vec4>& partial,
           const Visit& visit) {
    const auto* blocks = std::get_if<Interleaved>(&share);
    if (blocks == nullptr)
        return parallel_blocks(gbuffer.pixels(), 16384, [&](std::size_t begin, std::size_t end) {
            visit(begin, partial.span().subspan(begin, end - begin));
        });
    const InterleavedMerge merge{*blocks, gbuffer, weights, partial};
    parallel_tiles(gbuffer.width, gbuffer.height, merge_tile_size, [&](const Tile& tile) {
        alignas(64) std::array<vec4, merge_tile_size * merge_tile_size> merged;
        merge.tile(tile, merged.data());
        for (int y = tile.y0; y < tile.y1; ++y)
            visit(static_cast<std::size_t>(y) * gbuffer.width + tile.x0,
                  std::span<const vec4>(merged).subspan((y - tile.y0) * merge_tile_size, tile.x1 - tile.x0));
    });
}

}  // namespace interreflect
