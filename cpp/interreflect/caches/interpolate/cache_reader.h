/// What one cache holds for one pixel.
#pragma once
#include "caches/interpolate/cache_light.h"
#include "caches/interpolate/pixel_views.h"

namespace interreflect {

/// Means over the pixel's cosine lobe and, where it has one, over its glossy lobe: from the convolved maps, or by sampling the
/// lobes over the filled one. What lies below the cache's horizon is not known, and counts as what is.
class CacheReader {
  public:
    CacheReader(const ConvolvedCaches& caches, const GBuffer& gbuffer, const Scene& scene)
        : caches_(caches), gbuffer_(gbuffer), scene_(scene) {}

    /// Weight 1.
    CacheSum read(std::size_t cache, const PixelViews::View& view) const;

  private:
    struct Place {  // in one layer
        const std::uint16_t* filled;
        const std::uint16_t* chain;
        const std::uint16_t* table;
    };
    Place place(const Buffer<std::uint16_t>& filled, const ConvolvedCaches::Layer& layer, std::size_t cache) const;
    vec4 at_level(const Place& place, int level, const vec2& square) const;
    CacheSum sample(std::size_t cache, const PixelViews::View& view) const;

    const ConvolvedCaches& caches_;
    const GBuffer& gbuffer_;
    const Scene& scene_;
};

/// Bilinear between the texels' centres of an n x n map; beyond the outermost ones as they are.
vec4 read_map(const std::uint16_t* texels, int n, const vec2& square);

}  // namespace interreflect
