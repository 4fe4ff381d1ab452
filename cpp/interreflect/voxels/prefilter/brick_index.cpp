#include "voxels/prefilter/brick_index.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr int side = TexelBricks::side, edge = TexelBricks::edge;

/// Where a texel stands along one axis: in one brick, in two that meet there, and at the level's end in its border too.
struct Slots {
    int brick[4], within[4], count = 0;

    Slots(int x, int size, int bricks) {
        add(x + 1, bricks);
        if (x == 0) add(0, bricks);
        if (x + 1 == size) add(size + 1, bricks);
    }

  private:
    void add(int texel, int bricks) {  // counted from the border on
        if (texel / side < bricks) put(texel / side, texel % side);
        if (texel % side == 0 && texel > 0) put(texel / side - 1, side);
    }
    void put(int number, int place) {
        brick[count] = number;
        within[count++] = place;
    }
};

/// Calls visit(brick's place, texel's place within it, number of the texel) for all of a layer of bricks.
template <class Visit>
void over_layer(const Pyramid::Level& level, std::span<const std::uint32_t> cells, int layer, const Visit& visit) {
    const ivec3 count = level.bricks.count, size = level.size;
    const auto per_slice = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y);
    const auto first_of = [&](int z) {
        return std::lower_bound(cells.begin(), cells.end(), static_cast<std::uint64_t>(std::max(z, 0)) * per_slice) -
               cells.begin();
    };
    // Texel -1 is the first of the first brick, and of each the last is the next one's first.
    for (auto i = first_of(side * layer - 1), end = first_of(side * layer + side); i < end; ++i) {
        const std::uint32_t cell = cells[static_cast<std::size_t>(i)], row = cell / static_cast<std::uint32_t>(size.x);
        const Slots x(static_cast<int>(cell % static_cast<std::uint32_t>(size.x)), size.x, count.x);
        const Slots y(static_cast<int>(row % static_cast<std::uint32_t>(size.y)), size.y, count.y);
        const Slots z(static_cast<int>(row / static_cast<std::uint32_t>(size.y)), size.z, count.z);
        for (int c = 0; c < z.count; ++c) {
            if (z.brick[c] != layer) continue;
            for (int b = 0; b < y.count; ++b)
                for (int a = 0; a < x.count; ++a)
                    visit(static_cast<std::size_t>(x.brick[a] + count.x * (y.brick[b] + count.y * layer)),
                          static_cast<std::size_t>(x.within[a] + edge * (y.within[b] + edge * z.within[c])),
                          static_cast<std::uint32_t>(i + 1));
        }
    }
}

}  // namespace

void index_bricks(Pyramid::Level& level, std::span<const std::uint32_t> cells) {
    TexelBricks& bricks = level.bricks;
    const std::size_t per_layer = static_cast<std::size_t>(bricks.count.x) * static_cast<std::size_t>(bricks.count.y);
    const auto layers = static_cast<std::size_t>(bricks.count.z);
    bricks.brick = Buffer<std::int32_t>(per_layer * layers, 0);
    parallel_pieces(layers, [&](std::size_t layer) {
        over_layer(level, cells, static_cast<int>(layer),
                   [&](std::size_t brick, std::size_t, std::uint32_t) { bricks.brick[brick] = 1; });
    });
    std::int32_t last = 0;
    for (auto& number : bricks.brick)
        if (number != 0) number = ++last;
    bricks.texel = Buffer<std::uint32_t>((static_cast<std::size_t>(last) + 1) * TexelBricks::volume);
    std::fill_n(bricks.texel.begin(), TexelBricks::volume, 0U);
    parallel_pieces(layers, [&](std::size_t layer) {
        for (std::size_t i = layer * per_layer; i < (layer + 1) * per_layer; ++i)
            if (bricks.brick[i] != 0)
                std::fill_n(&bricks.texel[static_cast<std::size_t>(bricks.brick[i]) * TexelBricks::volume], TexelBricks::volume,
                            0U);
        over_layer(level, cells, static_cast<int>(layer), [&](std::size_t brick, std::size_t place, std::uint32_t number) {
            bricks.texel[static_cast<std::size_t>(bricks.brick[brick]) * TexelBricks::volume + place] = number;
        });
    });
}

}  // namespace interreflect
