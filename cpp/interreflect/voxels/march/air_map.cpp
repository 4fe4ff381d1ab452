#include "voxels/march/air_map.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {
namespace {

/// Marks the texels of row (y, z) that are not air, in bit x. A texel is air in all of a level's volumes or in none.
void mark_row(const Pyramid::Level& level, int y, int z, std::uint32_t* bits) {
    const std::uint16_t* texel = level.texels.data() + 4 * level.index(0, y, z);
    for (int x = 0; x < level.size.x; ++x, texel += 4) bits[x >> 5] |= static_cast<std::uint32_t>(texel[3] != 0) << (x & 31);
}

AirMap::Level map_level(const Pyramid::Level& level) {
    AirMap::Level map;
    map.row_words = static_cast<std::uint32_t>(level.size.x) / 32 + 1;
    map.slice_words = map.row_words * (static_cast<std::uint32_t>(level.size.y) + 1);
    const std::size_t row = map.row_words;
    std::vector<std::uint32_t> texels(row * static_cast<std::size_t>(level.size.y) * static_cast<std::size_t>(level.size.z));
    const auto texel_row = [&](int y, int z) {
        const int cy = std::clamp(y, 0, level.size.y - 1), cz = std::clamp(z, 0, level.size.z - 1);  // the border repeats
        return &texels[row *
                       (static_cast<std::size_t>(cz) * static_cast<std::size_t>(level.size.y) + static_cast<std::size_t>(cy))];
    };
    parallel_pieces(static_cast<std::size_t>(level.size.z), [&](std::size_t z) {
        for (int y = 0; y < level.size.y; ++y) mark_row(level, y, static_cast<int>(z), texel_row(y, static_cast<int>(z)));
    });
    map.words.resize(map.slice_words * (static_cast<std::size_t>(level.size.z) + 1));
    parallel_pieces(static_cast<std::size_t>(level.size.z) + 1, [&](std::size_t slice) {
        std::uint32_t* out = &map.words[map.slice_words * slice];
        const int z = static_cast<int>(slice) - 1;
        for (int y = -1; y < level.size.y; ++y) {
            const std::uint32_t* rows[4] = {texel_row(y, z), texel_row(y + 1, z), texel_row(y, z + 1), texel_row(y + 1, z + 1)};
            std::uint32_t before = 0;
            for (std::size_t i = 0; i < row; ++i) {
                const std::uint32_t any = rows[0][i] | rows[1][i] | rows[2][i] | rows[3][i];
                *out++ = any | any << 1 | before >> 31;  // tap x reads texels x and x + 1
                before = any;
            }
        }
    });
    return map;
}

}  // namespace

AirMap::AirMap(const Pyramid& pyramid) {
    const int count = static_cast<int>(pyramid.levels.size());
    for (int i = first_level; i <= last_level && i < count; ++i)
        levels_.push_back(pyramid.levels[static_cast<std::size_t>(i)].dense()
                              ? map_level(pyramid.levels[static_cast<std::size_t>(i)])
                              : Level{});
}

}  // namespace interreflect
