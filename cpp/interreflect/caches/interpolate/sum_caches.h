/// The weighted sums of what caches hold for pixels.
#pragma once
#include <span>

#include "caches/interpolate/cache_sums.h"
#include "caches/interpolate/weights.h"

namespace interreflect {

/// Sums up what CacheReader reads, times the weights.
class CacheSummer {
  public:
    CacheSummer(const ConvolvedCaches& caches, const CacheWeights& weights, const GBuffer& gbuffer, const Scene& scene)
        : caches_(caches), weights_(weights), gbuffer_(gbuffer), scene_(scene) {}

    /// Of some caches, one after another; returns how many pixels they reach, each counted anew by every cache.
    std::uint64_t sum(std::span<const std::uint32_t> near, const PixelViews& views, CacheSums& sums) const;

  private:
    const ConvolvedCaches& caches_;
    const CacheWeights& weights_;
    const GBuffer& gbuffer_;
    const Scene& scene_;
};

}  // namespace interreflect
