/// The weighted sums of what caches hold for pixels.
#pragma once
#include "caches/interpolate/cache_sums.h"
#include "caches/interpolate/weights.h"

namespace interreflect {

/// Adds caches to the sums of pixels, one cache at a time: what CacheReader reads, times the weight.
class CacheSummer {
  public:
    CacheSummer(const ConvolvedCaches& caches, const CacheWeights& weights, const GBuffer& gbuffer, const Scene& scene)
        : caches_(caches), weights_(weights), gbuffer_(gbuffer), scene_(scene) {}

    /// Returns how many of the pixels the cache reaches.
    std::uint64_t add(std::size_t cache, const PixelViews& views, CacheSums& sums) const;

  private:
    const ConvolvedCaches& caches_;
    const CacheWeights& weights_;
    const GBuffer& gbuffer_;
    const Scene& scene_;
};

}  // namespace interreflect
