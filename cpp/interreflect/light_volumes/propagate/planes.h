/// A light volume as vectors read it: plane by plane, with air around it.
#pragma once
#include <cstddef>

#include "data/light_volume.h"
#include "math/parallel.h"

namespace interreflect {

/// Most lanes of a vector: rows may be read so far beyond their end.
inline constexpr std::size_t row_slack = 16;

/// One plane for each coefficient of each colour; cells with a border of zeros.
class Planes {
  public:
    static constexpr int count = LightVolume::values;

    explicit Planes(const ivec3& cells)
        : cells_(cells),
          row_((static_cast<std::size_t>(cells.x) + row_slack - 1) / row_slack * row_slack + 2),
          slice_(row_ * (static_cast<std::size_t>(cells.y) + 2)),
          size_(slice_ * (static_cast<std::size_t>(cells.z) + 2)),
          values_(size_ * count, 0.0f) {}

    /// The first cell of a row.
    float* row(int plane, int y, int z) { return values_.data() + start(plane, y, z); }
    const float* row(int plane, int y, int z) const { return values_.data() + start(plane, y, z); }
    /// From a cell to the next along an axis.
    std::ptrdiff_t step(int axis) const { return static_cast<std::ptrdiff_t>(axis == 0 ? 1 : axis == 1 ? row_ : slice_); }

    /// Calls body(y, z) for every row of cells, from all threads.
    template <class Body>
    void each_row(const Body& body) const {
        constexpr std::size_t together = 8;
        parallel_blocks(static_cast<std::size_t>(cells_.y) * cells_.z, together, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) body(static_cast<int>(i % cells_.y), static_cast<int>(i / cells_.y));
        });
    }

  private:
    std::size_t start(int plane, int y, int z) const {
        return static_cast<std::size_t>(plane) * size_ + static_cast<std::size_t>(z + 1) * slice_ +
               static_cast<std::size_t>(y + 1) * row_ + 1;
    }
    ivec3 cells_;
    std::size_t row_, slice_, size_;
    Buffer<float> values_;
};

}  // namespace interreflect
