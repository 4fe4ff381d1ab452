#include "voxels/prefilter/brick_index.h"

#include <algorithm>
#include <vector>

#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr int side = TexelBricks::side;

/// The bricks in which texel x stands along one axis, in both where two meet. Its copies in the border are in the same.
template <class Visit>
void over_bricks_of(int x, const Visit& visit) {
    const int first = x / side, second = (x + 1) / side;
    visit(first);
    if (second != first) visit(second);
}

/// Marks the bricks of one layer, of [0, x fastest), in which a texel stands.
void mark_layer(const Pyramid::Level& level, std::span<const std::uint32_t> cells, int layer, std::int32_t* marks) {
    const ivec3 count = level.bricks.count, size = level.size;
    std::vector<std::uint8_t> row(static_cast<std::size_t>(count.x));
    // Texel -1 is the first of the first brick, and of each the last is the next one's first.
    over_rows(size, cells, side * layer - 1, side * layer + side, [&](const ivec3& at, std::size_t begin, std::size_t end) {
        bool here = false;
        over_bricks_of(at.z, [&](int z) { here |= z == layer; });
        if (!here) return;
        std::fill(row.begin(), row.end(), std::uint8_t{0});
        const auto first = static_cast<std::uint32_t>(size.x) * static_cast<std::uint32_t>(at.y + size.y * at.z);
        for (std::size_t i = begin; i < end; ++i)
            over_bricks_of(static_cast<int>(cells[i] - first), [&](int x) { row[static_cast<std::size_t>(x)] = 1; });
        over_bricks_of(at.y, [&](int y) {
            std::int32_t* out = marks + static_cast<std::ptrdiff_t>(y) * count.x;
            for (std::size_t x = 0; x < row.size(); ++x) out[x] |= row[x];
        });
    });
}

}  // namespace

void number_bricks(Pyramid::Level& level, std::span<const std::uint32_t> cells) {
    TexelBricks& bricks = level.bricks;
    const std::size_t per_layer = static_cast<std::size_t>(bricks.count.x) * static_cast<std::size_t>(bricks.count.y);
    const auto layers = static_cast<std::size_t>(bricks.count.z);
    bricks.brick = Buffer<std::int32_t>(per_layer * layers, 0);
    parallel_pieces(
        layers, [&](std::size_t layer) { mark_layer(level, cells, static_cast<int>(layer), &bricks.brick[layer * per_layer]); });
    std::int32_t last = 0;
    for (auto& number : bricks.brick)
        if (number != 0) number = ++last;
    bricks.texel = Buffer<std::uint32_t>((static_cast<std::size_t>(last) + 1) * TexelBricks::volume);
    std::fill_n(bricks.texel.begin(), TexelBricks::volume, 0U);
}

}  // namespace interreflect
