/// Where the texels of a level are kept of which most are air.
#pragma once
#include <algorithm>
#include <cstdint>

#include "data/buffer.h"
#include "math/vectors.h"

namespace interreflect {

/// A level's taps in bricks of 4 x 4 x 4, each with the numbers of the 5 x 5 x 5 texels that its taps read, so that no tap leaves
/// its brick. A texel's number is that of its first volume, the next one's is 1 more. Number 0 is air; all bricks whose texels
/// are air are one, number 0.
///
/// The tap at b reads texels b and b + 1 of [-1, size] along each axis; it lies in brick (b + 1) / 4.
struct TexelBricks {
    static constexpr int side = 4, edge = side + 1, volume = edge * edge * edge;

    ivec3 count{0};               // of bricks; 0: the level has none
    Buffer<std::int32_t> brick;   // number of brick (x, y, z), x fastest
    Buffer<std::uint32_t> texel;  // `volume` numbers of each brick, x fastest

    static ivec3 count_for(const ivec3& size) { return size / side + 1; }
    std::size_t bytes() const { return brick.bytes() + texel.bytes(); }
    /// Number of a texel, each coordinate in [-1, size].
    std::uint32_t at(int x, int y, int z) const {
        const ivec3 tap = ivec3(x, y, z) + 1, b = glm::min(tap / side, count - 1), in = tap - b * side;
        const std::ptrdiff_t rows = b.y + static_cast<std::ptrdiff_t>(count.y) * b.z, number = brick[b.x + count.x * rows];
        return texel[number * volume + in.x + edge * (in.y + edge * in.z)];
    }
};

}  // namespace interreflect
