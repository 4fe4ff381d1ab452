/// Where a trilinear tap of a coarse level can only read air: one bit a tap, small enough for a core's first cache.
#pragma once
#include <cstdint>
#include <vector>

#include "data/voxel_grid.h"

namespace interreflect {

class AirMap {
  public:
    /// The second and third level: finer ones come with a coarser one in most steps, coarser ones hold hardly any air.
    static constexpr int first_level = 1, last_level = 2;

    /// Bits of the taps whose first texel is (x, y, z), each from -1 on; 1: one of the eight texels is not air.
    struct Level {
        std::uint32_t row_words = 0, slice_words = 0;
        std::vector<std::uint32_t> words;  // tap x in bit x + 1 of row (y + 1, z + 1)
    };

    explicit AirMap(const Pyramid& pyramid);
    /// Null for a level that has no map: one in bricks needs none.
    const Level* of(int level) const {
        const int i = level - first_level;
        if (i < 0 || i >= static_cast<int>(levels_.size())) return nullptr;
        const Level& map = levels_[static_cast<std::size_t>(i)];
        return map.words.empty() ? nullptr : &map;
    }

  private:
    std::vector<Level> levels_;
};

}  // namespace interreflect
