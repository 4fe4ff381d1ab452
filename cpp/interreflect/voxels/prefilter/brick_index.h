/// The bricks of a level from the places of its texels.
#pragma once
#include <cstdint>
#include <span>

#include "data/voxel_grid.h"

namespace interreflect {

/// Numbers the bricks (whose count is known) of a level whose texels stand in `cells`, x fastest, ascending, and makes room for
/// the numbers of their texels, those of brick 0 filled in. The outermost texels stand in the border too.
void number_bricks(Pyramid::Level& level, std::span<const std::uint32_t> cells);

/// Calls visit(row, begin, end) for the rows of texels with cells [begin, end) among them, of slices [first, last).
template <class Visit>
void over_rows(const ivec3& size, std::span<const std::uint32_t> cells, int first, int last, const Visit& visit) {
    const auto width = static_cast<std::uint64_t>(size.x), per_slice = width * static_cast<std::uint64_t>(size.y);
    const auto place_of = [&](int z) {
        const auto from = static_cast<std::uint64_t>(std::clamp(z, 0, size.z)) * per_slice;
        return static_cast<std::size_t>(std::lower_bound(cells.begin(), cells.end(), from) - cells.begin());
    };
    const std::size_t end = place_of(last);
    for (std::size_t i = place_of(first); i < end;) {
        const std::uint64_t row = cells[i] / width;
        std::size_t next = i + 1;
        while (next < end && cells[next] < (row + 1) * width) ++next;
        const auto y = static_cast<int>(row % static_cast<std::uint64_t>(size.y)),
                   z = static_cast<int>(row / static_cast<std::uint64_t>(size.y));
        visit(ivec3(0, y, z), i, next);
        i = next;
    }
}

}  // namespace interreflect
