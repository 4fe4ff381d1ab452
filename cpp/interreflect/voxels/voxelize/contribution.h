/// The parts of triangles in cells: what voxelizations emit, and which cells they occupy.
#pragma once
#include <atomic>
#include <bit>
#include <cstdint>

#include "data/buffer.h"
#include "data/scene.h"
#include "data/voxel_grid.h"

namespace interreflect {

/// A triangle, or a piece of one, in units of one grid's voxels from its lower corner, with what its surface looks like.
struct VoxelTriangle {
    vec3 corner[3];
    vec2 texcoord[3];
    vec3 normal{0};        // unit, in the space of `corner`; the front side's where that is not warped
    vec3 facing{0};        // unit, front side, world space
    float area = 0;        // in faces of a voxel
    float offset = 0;      // of rays that leave it, world space
    bool crosses = false;  // the grid's border
    int cascade = 0;       // the grid
    vec3 linear[3];        // the corners in linear voxels, where the domain is not plain
    const Material* material = nullptr;
    const Texture* albedo_map = nullptr;
    const Texture* emission_map = nullptr;
    const Mask* mask = nullptr;

    bool uniform() const { return albedo_map == nullptr && emission_map == nullptr && mask == nullptr; }
    /// The mip level whose texels are as large as `sample_area` (faces of a voxel) of this triangle.
    int level(const Texture& texture, float sample_area) const;
};

/// How a voxelization wants to be handed triangles where the domain is not plain.
enum class Handing {
    pieces,   // flat ones in warped voxels, each in one of nested grids: a sample in `corner`s' space is where it lies
    sampled,  // the same, larger and not so flat: the sink warps every sample
    grids,    // whole, in linear voxels, once for each of nested grids; the sink warps samples and keeps those of that grid
    at_once,  // whole, in linear voxels of the finest grid, once; the sink warps samples and finds their grid
};

/// The part of one triangle in one cell. Sums are weighted by area.
struct Contribution {
    vec4 albedo{0};    // sum; the fourth: area of the solid part, in faces of a voxel
    vec4 position{0};  // sum, in linear voxels from Domain::reference of the cell; the fourth: area with the holes of the mask
    std::uint32_t cell = 0;
    std::uint32_t side = 0;  // number of the triangle's TriangleSide in its piece of the scene

    float area() const { return albedo.w; }
    float total() const { return position.w; }
};
/// What all contributions of a triangle share.
struct TriangleSide {
    vec4 normal;         // unit, front side, world space; the fourth: VoxelTriangle::offset
    std::uint32_t back;  // whether its back reflects

    float offset() const { return normal.w; }
};
struct EmissionContribution {
    std::uint32_t cell = 0;
    vec3 emission{0};  // sum
};

/// The cells that hold something solid, marked by all threads; the marks owe nothing to their order.
class CellMarks {
  public:
    explicit CellMarks(std::size_t cells) : words_((cells + 63) / 64, 0), first_(words_.size() + 1) {}

    void mark(std::uint32_t cell) {
        const std::uint64_t bit = std::uint64_t{1} << (cell & 63U);
        std::atomic_ref<std::uint64_t> word(words_[cell >> 6U]);
        if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
    }
    /// Numbers the marked cells in ascending order.
    void number();
    bool marked(std::uint32_t cell) const { return ((words_[cell >> 6U] >> (cell & 63U)) & 1U) != 0; }
    /// How many marked cells come before this one.
    std::uint32_t before(std::uint64_t cell) const {
        const std::size_t word = cell >> 6U;
        if (word == words_.size()) return count();
        const std::uint64_t below = (std::uint64_t{1} << (cell & 63U)) - 1;
        return first_[word] + static_cast<std::uint32_t>(std::popcount(words_[word] & below));
    }
    std::uint32_t count() const { return first_[words_.size()]; }
    /// Calls visit(cell) for the marked cells of [begin, end) in ascending order; both multiples of 64, or the end of all.
    template <class Visit>
    void for_each(std::uint64_t begin, std::uint64_t end, const Visit& visit) const {
        for (std::uint64_t word = begin / 64; word < (end + 63) / 64; ++word)
            for (std::uint64_t bits = words_[word]; bits != 0; bits &= bits - 1)
                visit(static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(bits)));
    }

  private:
    Buffer<std::uint64_t> words_;
    Buffer<std::uint32_t> first_;
};

}  // namespace interreflect
