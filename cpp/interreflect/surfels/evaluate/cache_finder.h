/// Which caches a pixel's light is interpolated from.
#pragma once
#include <algorithm>
#include <cstdint>

#include "data/gbuffer.h"
#include "data/light_caches.h"

namespace interreflect {

/// Of a run of pixels, slot by slot: at most eight each, or eight in each of two levels of a grid. The weights of a pixel sum up
/// to 1, or to 0 where no cache is near or nothing was hit; slots that are not used weigh 0.
struct NearCaches {
    static constexpr int length = 256, level_slots = 8, most_slots = 2 * level_slots;

    int slots = level_slots;  // of the sites
    alignas(64) std::uint32_t cache[most_slots][length];
    alignas(64) float weight[most_slots][length];

    /// Slots of the first `pixels` pixels that are used.
    void count(int pixels, std::int32_t* used) const {
        std::fill_n(used, pixels, 0);
        for (int slot = 0; slot < slots; ++slot)
            for (int pixel = 0; pixel < pixels; ++pixel) used[pixel] += weight[slot][pixel] > 0.0f ? 1 : 0;
    }
};

/// Bilinear in the light map where the pixel's triangle has a chart, else trilinear in the grid, in the level that
/// reaches it from the camera; caches that are missing give
/// their weight to the others [Jendersie et al. 2016, 3.2].
class CacheFinder {
  public:
    CacheFinder(const CacheSites& sites, const GBuffer& gbuffer);
    /// Of pixels [first, first + count), at most NearCaches::length.
    void find(std::size_t first, int count, NearCaches& near) const;

  private:
    const CacheSites& sites_;
    const GBuffer& gbuffer_;
    Buffer<std::uint32_t> of_pixel_;  // PixelCaches
};

}  // namespace interreflect
