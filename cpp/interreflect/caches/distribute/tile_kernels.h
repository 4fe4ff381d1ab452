/// What is done to every pixel of a tile, many at a time: rows of the G-buffer in, numbers out.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/vectors.h"

namespace interreflect {

/// The octahedral map's bin of each of `count` normals, bins * bins of them, row by row.
void bin_normals(const vec3* normal, std::size_t count, int bins, std::uint32_t* bin);

/// The signed axis, of three, to which each normal is nearest: 0 to 5.
void nearest_axes(const vec3* normal, std::size_t count, const std::array<vec3, 3>& axes, std::uint32_t* axis);

/// Of each positive distance floor(log2(distance * inverse_near) * an_octave) + 2^20, within [0, 2^21]; all bits where it is
/// infinite.
void slice_depths(const float* distance, std::size_t count, float inverse_near, float an_octave, std::uint32_t* slice);

/// Of each cluster the line through the middle of its box along its mean normal, and one over the box's diagonal.
struct ClusterLines {
    std::vector<float> of;  // of every cluster the centre's x, then of every one its y, and so on
    std::size_t size = 0;

    void reset(std::size_t clusters) {
        size = clusters;
        of.resize(7 * size);
    }
    void set(std::size_t i, const vec3& centre, const vec3& normal, float inverse_extent) {
        const std::array<float, 7> each = {centre.x, centre.y, centre.z, normal.x, normal.y, normal.z, inverse_extent};
        for (std::size_t k = 0; k < each.size(); ++k) of[k * size + i] = each[k];
    }
};

/// The score of each pixel for its cluster (TileClusters::choose_pixels); of those in no cluster anything.
void score_pixels(const vec3* position, const vec3* normal, const std::uint32_t* slot, std::size_t count,
                  const ClusterLines& lines, float* score);

}  // namespace interreflect
