#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "voxels/prefilter/levels.h"

namespace interreflect {
namespace {

/// The vectors as floats, three each; there may be none.
const float* floats(const Buffer<vec3>& vectors) { return reinterpret_cast<const float*>(vectors.data()); }

}  // namespace

Pyramid make_levels(const Domain& domain, int faces, const LevelKnobs& knobs) {
    if (domain.cascades > 1) throw std::invalid_argument("prefilter: nested grids cannot be filtered so far");
    Pyramid pyramid;
    pyramid.domain = domain;
    pyramid.faces = faces;
    for (ivec3 size = domain.cells;; size = (size + 1) / 2) {
        Pyramid::Level level;
        level.size = size;
        level.faces = pyramid.levels.empty() && faces == 6 ? 1 : faces;
        level.texels = Buffer<std::uint16_t>(level.volume() * static_cast<std::size_t>(level.faces) * 4);
        pyramid.levels.push_back(std::move(level));
        if (size == ivec3(1) || static_cast<int>(pyramid.levels.size()) == knobs.levels) return pyramid;
    }
}

float radiance_scale(const LitVoxels& lit) {
    // Floats that are not negative are ordered as their bits are, which compilers compare many at a time.
    std::int32_t most = 0, size = 0;
    for (const Buffer<vec3>* side : {&lit.radiance, &lit.back}) {
        const float* values = floats(*side);
        for (std::size_t i = 0; i < 3 * side->size(); ++i) {
            const auto bits = std::bit_cast<std::int32_t>(values[i]);
            most = std::max(most, bits);
            size = std::max(size, bits & 0x7fffffff);
        }
    }
    if (size >= 0x7f800000) throw std::invalid_argument("prefilter: a voxel's radiance is not finite");
    const auto largest = std::bit_cast<float>(most);
    if (!(largest > 0.0f)) return 1.0f;
    // Twice 2^-14 below the least float: its inverse must stay finite.
    return std::ldexp(1.0f, std::clamp(std::ilogb(largest), -110, 127) - 14);
}

LevelView view(Pyramid::Level& level) {
    return {level.texels.data(), level.size.x,      level.size.y,      level.size.z,
            level.row() * 4,     level.slice() * 4, level.volume() * 4};
}

VoxelView view(const LitVoxels& lit, float scale) {
    const VoxelGrid& grid = *lit.grid;
    return {grid.cell.data(),
            floats(lit.radiance),
            lit.back.empty() ? nullptr : floats(lit.back),
            floats(grid.normal),
            grid.opacity.data(),
            grid.points.data(),
            0,
            grid.size(),
            1.0f / scale};
}

VoxelView slices_of(VoxelView voxels, const Domain& domain, int z) {
    const auto per_slice = static_cast<std::uint64_t>(domain.cells.x) * static_cast<std::uint64_t>(domain.cells.y);
    const auto first_of = [&](std::uint64_t slice) {
        const auto* end = voxels.cell + voxels.end;
        return static_cast<std::size_t>(std::lower_bound(voxels.cell, end, slice * per_slice) - voxels.cell);
    };
    const std::size_t begin = first_of(2 * static_cast<std::uint64_t>(z)), end = first_of(2 * static_cast<std::uint64_t>(z) + 2);
    voxels.begin = begin, voxels.end = end;
    return voxels;
}

void fill_border(Pyramid::Level& level) {
    constexpr std::size_t texel = 4;
    const std::size_t row = level.row() * texel, slice = level.slice() * texel;
    for (int face = 0; face < level.faces; ++face) {
        std::uint16_t* volume = level.texels.data() + static_cast<std::size_t>(face) * level.volume() * texel;
        for (int z = 1; z <= level.size.z; ++z) {
            std::uint16_t* first = volume + static_cast<std::size_t>(z) * slice;
            for (int y = 1; y <= level.size.y; ++y) {
                std::uint16_t* line = first + static_cast<std::size_t>(y) * row;
                std::memcpy(line, line + texel, texel * sizeof(*line));
                std::memcpy(line + row - texel, line + row - 2 * texel, texel * sizeof(*line));
            }
            std::memcpy(first, first + row, row * sizeof(*first));
            std::memcpy(first + slice - row, first + slice - 2 * row, row * sizeof(*first));
        }
        const std::size_t last = static_cast<std::size_t>(level.size.z) + 1;
        std::memcpy(volume, volume + slice, slice * sizeof(*volume));
        std::memcpy(volume + last * slice, volume + (last - 1) * slice, slice * sizeof(*volume));
    }
}

}  // namespace interreflect
