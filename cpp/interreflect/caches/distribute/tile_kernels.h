/// What is done to every pixel of a tile, many at a time: numbers in, numbers out.
///
/// Kernels read and write whole vectors, so all arrays end with room for one more: with_room(count) items.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "math/vectors.h"

namespace interreflect {

inline constexpr std::size_t most_at_once = 16;
/// Items of an array for `count` that is read and written from any of them on.
constexpr std::size_t with_room(std::size_t count) { return count + most_at_once; }

/// Vectors by their coordinates: of all x, y and z.
using Coordinates = std::array<std::vector<float>, 3>;

/// A rectangle of a picture: pixels from `first` on, `step` from row to row.
struct Rows {
    std::size_t first = 0, step = 0, columns = 0, count = 0;
};

/// The items of a rectangle, row by row. `from` is the whole picture.
void copy_vectors(std::span<const vec3> from, const Rows& rows, Coordinates& to);
void copy_numbers(std::span<const float> from, const Rows& rows, std::vector<float>& to);

/// Adds 1 to the octahedral map's bin of each of `count` normals whose depth is finite: bins * bins of them, row by row.
void count_normals(const Coordinates& normal, const float* depth, std::size_t count, int bins, float* histogram);

/// Where the first of the largest numbers is; `count` above 0, with room, none of them below 0.
std::size_t first_largest(const float* numbers, std::size_t count);

/// The signed axis, of three, to which each normal is nearest: 0 to 5.
void nearest_axes(const Coordinates& normal, std::size_t count, const std::array<vec3, 3>& axes, std::uint32_t* axis);

/// Of each positive distance floor(log2(distance * inverse_near) * an_octave) + 2^20, within [0, 2^21]; all bits where it is
/// infinite.
void slice_depths(const float* distance, std::size_t count, float inverse_near, float an_octave, std::uint32_t* slice);

/// Of each cluster the line through the middle of its box along its mean normal, and one over the box's diagonal.
struct ClusterLines {
    std::vector<float> of;  // of every cluster the centre's x, then of every one its y, and so on
    std::size_t size = 0;   // of each part: the clusters, with room

    void reset(std::size_t clusters) {
        size = with_room(clusters);
        of.resize(7 * size);
    }
    void set(std::size_t i, const vec3& centre, const vec3& normal, float inverse_extent) {
        const std::array<float, 7> each = {centre.x, centre.y, centre.z, normal.x, normal.y, normal.z, inverse_extent};
        for (std::size_t k = 0; k < each.size(); ++k) of[k * size + i] = each[k];
    }
};

/// Of a cluster the pixel with the best score so far.
struct BestPixel {
    float score;
    std::uint32_t pixel;
};

/// Finds the first pixel with the best score (TileClusters::choose_pixels) of every cluster. slot: each pixel's cluster, all bits
/// where it has none.
void best_pixels(const Coordinates& position, const Coordinates& normal, const std::uint32_t* slot, std::size_t count,
                 const ClusterLines& lines, BestPixel* best);

}  // namespace interreflect
