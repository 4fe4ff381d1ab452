/// The pixels of one tile of a G-buffer, copied side by side: a tile's rows are short, and kernels take many pixels at a time.
#pragma once
#include <cstddef>
#include <vector>

#include "caches/distribute/tile_kernels.h"
#include "data/gbuffer.h"
#include "math/parallel.h"

namespace interreflect {

/// Row by row, with room. Beyond the last pixel depths are infinite, as where nothing was hit; all else is anything.
class TilePixels {
  public:
    Coordinates normal, position;  // normal: shading
    std::vector<float> depth;

    std::size_t count() const { return rows_.columns * rows_.count; }
    const Rows& rows() const { return rows_; }
    /// The number in the picture of the tile's pixel i.
    std::size_t in_picture(std::size_t i) const { return rows_.first + i / rows_.columns * rows_.step + i % rows_.columns; }

    void load(const GBuffer& gbuffer, const Tile& tile);
    /// Of the tile that was loaded; apart, as those who count clusters do without.
    void load_positions(const GBuffer& gbuffer) { copy_vectors(gbuffer.position.span(), rows_, position); }

  private:
    Rows rows_;
};

}  // namespace interreflect
