#include "surfels/place/surfel_grid.h"

#include <bit>

#include "math/rng.h"

namespace interreflect {

std::size_t SurfelGrid::bucket_of(const Cell& c) const {
    const std::uint32_t x = static_cast<std::uint32_t>(c.x), y = static_cast<std::uint32_t>(c.y),
                        z = static_cast<std::uint32_t>(c.z);
    return hash32(x + hash32(y + hash32(z))) & (first_.size() - 2);
}

SurfelGrid::SurfelGrid(std::span<const vec3> positions, float cell)
    : per_length_(1.0f / cell), first_(std::bit_ceil(2 * positions.size() + 1) + 1), entries_(positions.size()) {
    std::vector<std::uint32_t> bucket(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        ++first_[(bucket[i] = static_cast<std::uint32_t>(bucket_of(cell_of(positions[i])))) + 1];
    for (std::size_t b = 1; b < first_.size(); ++b) first_[b] += first_[b - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < positions.size(); ++i)
        entries_[next[bucket[i]]++] = {cell_of(positions[i]), static_cast<std::uint32_t>(i)};
}

}  // namespace interreflect
