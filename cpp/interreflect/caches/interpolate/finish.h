/// From sums of caches to pixels' light.
#pragma once
#include <vector>

#include "caches/interpolate/cache_sums.h"
#include "math/parallel.h"

namespace interreflect {

/// What became of a block of pixels.
struct Served {
    std::uint64_t evaluations = 0, covered = 0;
    std::vector<std::uint32_t> uncovered;  // pixels
};

/// Zero, as where nothing is seen, unless all pixels of the tile see something and will be entered.
void clear_unseen(const Tile& tile, int seeing, CacheLight& light);

/// Enters the light of a pixel whose sum's weight is above 0.
void finish_pixel(const ConvolvedCaches& caches, const PixelViews::View& view, const CacheSum& sum, CacheLight& light);

/// Enters the light of the pixels that caches serve, and counts them and the others.
void finish_pixels(const ConvolvedCaches& caches, const PixelViews& views, const CacheSums& sums, CacheLight& light,
                   Served& served);

}  // namespace interreflect
