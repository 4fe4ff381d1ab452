/// Four slices of a level in bricks, laid out as a dense level for the kernels that make the next one from it.
#pragma once
#include <cstdint>
#include <span>

#include "data/voxel_grid.h"
#include "voxels/prefilter/levels.h"

namespace interreflect {

/// A thread's memory for one layer of bricks after the other, of one level.
class BrickLayer {
  public:
    /// `volumes`: how many are laid out; the others can be reached by the texels' numbers. `cells`: of texels 1, 2, ...
    BrickLayer(const Pyramid::Level& level, std::span<const std::uint32_t> cells, int volumes);

    /// Lays out slices 4 layer - 1 to 4 layer + 4 with their border.
    void fill(int layer);
    /// Writes the numbers of the layer's bricks.
    void write_bricks(std::uint32_t* texel) const;

    /// Of the volumes laid out, addressed by the level's own coordinates; only the slices of the last `fill` are there.
    LevelView texels() const;
    PackedView packed() const;

  private:
    static constexpr int slices = TexelBricks::side + 2;

    void put_rows();
    void repeat_outermost();
    int first_slice() const { return layer_ * TexelBricks::side - 1; }

    const Pyramid::Level& level_;
    std::span<const std::uint32_t> cells_;
    int volumes_, layer_ = 0;
    std::size_t row_, slice_, texel_row_, texel_slice_;  // strides, of numbers and of texels in halves
    Buffer<std::uint32_t> number_;
    Buffer<std::uint16_t> texels_;  // volume by volume
};

}  // namespace interreflect
