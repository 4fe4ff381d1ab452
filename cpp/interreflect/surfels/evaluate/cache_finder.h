/// Which caches a pixel's light is interpolated from.
#pragma once
#include <array>

#include "data/gbuffer.h"
#include "data/light_caches.h"
#include "data/scene.h"

namespace interreflect {

/// At most eight; the weights sum up to 1.
struct NearCaches {
    std::array<std::uint32_t, 8> cache;
    std::array<float, 8> weight;
    int count = 0;

    void add(std::uint32_t number, float by) {
        cache[static_cast<std::size_t>(count)] = number, weight[static_cast<std::size_t>(count++)] = by;
    }
};

/// Bilinear in the light map where the pixel's triangle has a chart, else trilinear in the grid; caches that are missing give
/// their weight to the others [Jendersie et al. 2016, 3.2].
class CacheFinder {
  public:
    CacheFinder(const CacheSites& sites, const GBuffer& gbuffer, const Scene& scene);
    /// None where nothing was hit, or where no cache is near.
    NearCaches find(std::size_t pixel) const;

  private:
    bool in_map(std::size_t pixel, NearCaches& near) const;
    void in_grid(std::size_t pixel, NearCaches& near) const;

    const CacheSites& sites_;
    const GBuffer& gbuffer_;
    const Scene& scene_;
    Buffer<std::uint32_t> of_pixel_;  // PixelCaches
};

}  // namespace interreflect
