/// Share: which part of a pixel's work does the pixel do itself, and how is the rest taken from its neighbours?
///
/// Pixels stand in blocks; a pixel's place in its block is its *phase*. A stage splits a pixel's work (cones, samples) among the
/// phases: each pixel writes the sum over its own part, and `merge` puts together what a whole pixel would have gathered.
/// Exact counterpart: EveryPixel.
#pragma once
#include <span>
#include <variant>
#include <vector>

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

/// What whole pixels would have gathered. `partial`: each pixel's sum over its own part of the work; `weights`: the share of the
/// whole that each phase does; they sum to 1. A uniform field comes out as it went in.
inline Buffer<vec4> merge(const Share& share, const GBuffer& gbuffer, std::span<const float> weights, Buffer<vec4> partial) {
    return std::visit([&](const auto& one) { return merge(one, gbuffer, weights, std::move(partial)); }, share);
}

}  // namespace interreflect
