/// What one cache holds for one pixel.
#pragma once
#include "caches/interpolate/cache_light.h"
#include "caches/interpolate/pixel_views.h"

namespace interreflect {

/// A cache's maps in one layer.
struct LayerMaps {
    const ConvolvedCaches& caches;
    const std::uint16_t* filled;
    const std::uint16_t* chain;
    const std::uint16_t* table;

    LayerMaps(const ConvolvedCaches& all, const Buffer<std::uint16_t>& texels, const ConvolvedCaches::Layer& layer,
              std::size_t cache)
        : caches(all),
          filled(texels.data() + 4 * cache * all.filled->texels_each()),
          chain(layer.chain.data() + 4 * cache * static_cast<std::size_t>(all.chain_texels)),
          table(layer.table.data() +
                4 * cache * static_cast<std::size_t>(all.table_size) * static_cast<std::size_t>(all.table_size)) {}
    const std::uint16_t* level(int i) const {
        return i == 0 ? filled : chain + 4 * caches.level_begins[static_cast<std::size_t>(i)];
    }
};

/// Means over the pixel's cosine lobe and, where it has one, over its glossy lobe: from the convolved maps, or by sampling the
/// lobes over the filled one. What lies below the cache's horizon is not known, and counts as what is.
class CacheReader {
  public:
    CacheReader(const ConvolvedCaches& caches, const GBuffer& gbuffer, const Scene& scene)
        : caches_(caches), gbuffer_(gbuffer), scene_(scene) {}

    /// Weight 1.
    CacheSum read(std::size_t cache, const PixelViews::View& view) const;

  private:
    CacheSum sample(std::size_t cache, const PixelViews::View& view) const;

    const ConvolvedCaches& caches_;
    const GBuffer& gbuffer_;
    const Scene& scene_;
};

/// Bilinear between the texels' centres of an n x n map; beyond the outermost ones as they are.
vec4 read_map(const std::uint16_t* texels, int n, const vec2& square);

}  // namespace interreflect
