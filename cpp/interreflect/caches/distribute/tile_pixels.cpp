#include "caches/distribute/tile_pixels.h"

#include <algorithm>
#include <limits>

namespace interreflect {

void TilePixels::load(const GBuffer& gbuffer, const Tile& tile) {
    const auto width = static_cast<std::size_t>(gbuffer.width);
    rows_ = {static_cast<std::size_t>(tile.y0) * width + static_cast<std::size_t>(tile.x0), width,
             static_cast<std::size_t>(tile.x1 - tile.x0), static_cast<std::size_t>(tile.y1 - tile.y0)};
    copy_vectors(gbuffer.normal.span(), rows_, normal);
    copy_numbers(gbuffer.depth.span(), rows_, depth);
    std::fill(depth.begin() + static_cast<std::ptrdiff_t>(count()), depth.end(), std::numeric_limits<float>::infinity());
}

}  // namespace interreflect
