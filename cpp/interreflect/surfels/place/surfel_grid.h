/// Which surfels lie near a place?
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vectors.h"

namespace interreflect {

/// Surfels on one side of a surface: what is said of neighbours holds between those whose normals are within 60 degrees, so
/// that neither a wall's other side nor the wall across a corner counts.
inline bool same_side(const vec3& normal, const vec3& other) { return glm::dot(normal, other) > 0.5f; }

/// Cells of a side of `cell`, in a table by their hash.
class SurfelGrid {
  public:
    SurfelGrid(std::span<const vec3> positions, float cell);

    /// Calls f(number) for every surfel in the 27 cells about a place, in an order of its own: all that are within `cell`, and
    /// others.
    template <class F>
    void for_each_near(const vec3& place, const F& f) const {
        const Cell middle = cell_of(place);
        for (std::int32_t k = 0; k < 27; ++k) {
            const Cell cell{middle.x + k % 3 - 1, middle.y + k / 3 % 3 - 1, middle.z + k / 9 - 1};
            const std::size_t bucket = bucket_of(cell);
            for (std::uint32_t i = first_[bucket]; i < first_[bucket + 1]; ++i)
                if (entries_[i].cell == cell) f(entries_[i].number);
        }
    }

  private:
    struct Cell {
        std::int32_t x, y, z;
        bool operator==(const Cell&) const = default;
    };
    struct Entry {
        Cell cell;
        std::uint32_t number;
    };
    Cell cell_of(const vec3& p) const {
        constexpr float most = 1e9f;  // beyond it all surfels of one row share cells
        const vec3 c = glm::clamp(glm::floor(p * per_length_), vec3(-most), vec3(most));
        return {static_cast<std::int32_t>(c.x), static_cast<std::int32_t>(c.y), static_cast<std::int32_t>(c.z)};
    }
    std::size_t bucket_of(const Cell& c) const;

    float per_length_;
    std::vector<std::uint32_t> first_;  // entry of each bucket; one more
    std::vector<Entry> entries_;
};

}  // namespace interreflect
