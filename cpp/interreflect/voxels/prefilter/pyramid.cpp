#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>

#include "voxels/prefilter/levels.h"

namespace interreflect {
namespace {

/// The vectors as floats, three each; there may be none.
const float* floats(const Buffer<vec3>& vectors) { return reinterpret_cast<const float*>(vectors.data()); }

constexpr int most_halvings = 10;  // of the finest grid there is, of 1024 voxels on a side

void clear_border(Pyramid::Level& level) {
    const ivec3 n = level.size;
    const auto clear = [&](int x, int y, int z, int face, std::size_t count) {
        std::memset(&level.texels[4 * level.index(x, y, z, face)], 0, 4 * count * sizeof(std::uint16_t));
    };
    for (int face = 0; face < level.faces; ++face) {
        clear(-1, -1, -1, face, level.slice());
        clear(-1, -1, n.z, face, level.slice());
        for (int z = 0; z < n.z; ++z) {
            clear(-1, -1, z, face, level.row());
            clear(-1, n.y, z, face, level.row());
            for (int y = 0; y < n.y; ++y) clear(-1, y, z, face, 1), clear(n.x, y, z, face, 1);
        }
    }
}

void raise(std::atomic<std::int32_t>& most, std::int32_t value) {
    for (std::int32_t known = most; known < value && !most.compare_exchange_weak(known, value);) {
    }
}

std::size_t halves_of(const Pyramid::Level& level) { return level.volume() * static_cast<std::size_t>(level.faces) * 4; }

std::string sizes_of(const Domain& domain) {
    const std::string one =
        std::to_string(domain.cells.x) + " x " + std::to_string(domain.cells.y) + " x " + std::to_string(domain.cells.z);
    return domain.cascades > 1 ? std::to_string(domain.cascades) + " x " + one : one;
}

/// How many of the levels, none of which has texels yet, are to be in bricks. Nested grids fill each other's levels: they have
/// none.
std::size_t levels_in_bricks(const Pyramid& pyramid, int dense_limit) {
    const auto much = static_cast<std::size_t>(dense_limit) << 20, some = much / 8;  // bytes
    std::size_t most = 0, count = 0;
    for (std::size_t i = 0; i < pyramid.levels.size(); ++i) {
        const std::size_t bytes = halves_of(pyramid.levels[i]) * sizeof(std::uint16_t);
        most = std::max(most, bytes);
        if (bytes > some) count = i + 1;
    }
    return most > much && pyramid.domain.cascades == 1 ? count : 0;
}

}  // namespace

Pyramid make_levels(const VoxelGrid& grid, int faces, const LevelKnobs& knobs) {
    const Domain& domain = grid.domain;
    const bool open = grid.pose.body != 0;
    if (knobs.levels != 0 && knobs.levels < domain.cascades)
        throw std::invalid_argument("prefilter: levels is " + std::to_string(knobs.levels) + ", but each of " +
                                    std::to_string(domain.cascades) + " nested grids is a level");
    Pyramid pyramid;
    pyramid.domain = domain;
    pyramid.pose = grid.pose;
    pyramid.faces = faces;
    for (ivec3 size = domain.cells;;) {
        const std::size_t number = pyramid.levels.size();
        Pyramid::Level level;
        level.size = size;
        level.open = open;
        level.origin = number < static_cast<std::size_t>(domain.cascades) ? domain.origin[number] : ivec3(0);
        level.faces = number == 0 && faces == 6 ? 1 : faces;
        pyramid.levels.push_back(std::move(level));
        const bool whole = size == ivec3(1) && (!open || static_cast<int>(number) == most_halvings);
        if (whole || static_cast<int>(number) + 1 == knobs.levels) break;
        if (static_cast<int>(number) + 1 >= domain.cascades) size = (size + 1) / 2;
    }
    const std::size_t in_bricks = open ? 0 : levels_in_bricks(pyramid, knobs.dense_limit);  // bricks repeat borders
    for (std::size_t i = 0; i < in_bricks; ++i) pyramid.levels[i].bricks.count = TexelBricks::count_for(pyramid.levels[i].size);
    const auto dense = std::span(pyramid.levels).subspan(in_bricks);
    std::uint64_t bytes = 0;
    for (const auto& level : dense) bytes += halves_of(level) * sizeof(std::uint16_t);
    if (bytes > most_bytes)
        throw std::invalid_argument("prefilter: a pyramid of " + sizes_of(domain) + " voxels would need " +
                                    std::to_string(bytes) + " bytes, and at most " + std::to_string(most_bytes) + " are allowed");
    for (auto& level : dense) level.texels = Buffer<std::uint16_t>(halves_of(level));
    return pyramid;
}

LevelView above(Pyramid& pyramid, std::size_t i) {
    const Pyramid::Level& fine = pyramid.levels[i];
    Pyramid::Level& coarse = pyramid.levels[i + 1];
    const ivec3 first = fine.origin / 2 - coarse.origin, size = (fine.size + 1) / 2;
    LevelView box = view(coarse);
    box.texels += 4 * (coarse.index(first.x, first.y, first.z) - coarse.index(0, 0, 0));
    box.nx = size.x, box.ny = size.y, box.nz = size.z;
    return box;
}

float radiance_scale(const LitVoxels& lit) {
    // Floats that are not negative are ordered as their bits are, which compilers compare many at a time.
    std::atomic<std::int32_t> most{0}, size{0};
    for (const Buffer<vec3>* side : {&lit.radiance, &lit.back}) {
        const float* values = floats(*side);
        parallel_blocks(3 * side->size(), 65536, [&](std::size_t begin, std::size_t end) {
            std::int32_t largest = 0, longest = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const auto bits = std::bit_cast<std::int32_t>(values[i]);
                largest = std::max(largest, bits);
                longest = std::max(longest, bits & 0x7fffffff);
            }
            raise(most, largest);
            raise(size, longest);
        });
    }
    if (size >= 0x7f800000) throw std::invalid_argument("prefilter: a voxel's radiance is not finite");
    const auto largest = std::bit_cast<float>(most.load());
    if (!(largest > 0.0f)) return 1.0f;
    // Twice 2^-14 below the least float: its inverse must stay finite.
    return std::ldexp(1.0f, std::clamp(std::ilogb(largest), -110, 127) - 14);
}

LevelView view(Pyramid::Level& level) {
    return {level.texels.data(), level.size.x,    level.size.y,      level.size.z,
            level.faces,         level.row() * 4, level.slice() * 4, level.volume() * 4};
}

Normals mean_normals(const LitVoxels& lit) { return {floats(lit.grid->normal)}; }

Normals front_normals(const LitVoxels& lit) {
    static_assert(sizeof(VoxelPoint) % sizeof(float) == 0);
    const auto& points = lit.grid->points;
    return {points.empty() ? nullptr : &points[0].normal.x, sizeof(VoxelPoint) / sizeof(float)};
}

namespace {

/// Normals of their own: turn(i, normal), for every voxel.
template <class Turn>
Normals turned(const Normals& normals, std::size_t size, const Turn& turn) {
    Buffer<vec3> own(size);
    parallel_blocks(size, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const float* n = normals.first + i * normals.stride;
            own[i] = turn(i, vec3(n[0], n[1], n[2]));
        }
    });
    const float* first = floats(own);
    return {first, 3, std::move(own)};
}

}  // namespace

Normals in_body(Normals normals, const LitVoxels& lit) {
    const BodyPose& pose = lit.grid->pose;
    if (pose.body == 0) return normals;
    return turned(normals, lit.grid->size(), [&](std::size_t, const vec3& n) { return pose.direction_to_body(n); });
}

Normals in_grid(Normals normals, const LitVoxels& lit) {
    const VoxelGrid& grid = *lit.grid;
    if (grid.domain.warp.kind == Warp::Kind::linear) return in_body(std::move(normals), lit);
    return turned(normals, grid.size(), [&](std::size_t i, const vec3& n) {
        const mat3 density = grid.domain.density(grid.domain.to_linear(grid.position[i]));
        const vec3 across = glm::transpose(glm::inverse(density)) * n;
        const float length = glm::length(across);
        return length > 0.0f ? across / length : vec3(0);
    });
}

VoxelView view(const LitVoxels& lit, float scale, const Normals& normals) {
    const VoxelGrid& grid = *lit.grid;
    return {grid.cell.data(),
            floats(lit.radiance),
            lit.back.empty() ? nullptr : floats(lit.back),
            grid.opacity.data(),
            normals.first,
            normals.stride,
            0,
            grid.size(),
            1.0f / scale};
}

VoxelView slices_of(VoxelView voxels, const LevelView& level, int z) {
    const auto per_slice = static_cast<std::uint64_t>(level.nx) * static_cast<std::uint64_t>(level.ny);
    const auto first_of = [&](std::uint64_t slice) {
        const auto* end = voxels.cell + voxels.end;
        return static_cast<std::size_t>(std::lower_bound(voxels.cell, end, voxels.base + slice * per_slice) - voxels.cell);
    };
    const std::size_t begin = first_of(2 * static_cast<std::uint64_t>(z)), end = first_of(2 * static_cast<std::uint64_t>(z) + 2);
    voxels.begin = begin, voxels.end = end;
    return voxels;
}

void fill_border(Pyramid::Level& level) {
    if (level.open) return clear_border(level);
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
