/// Caches of single pixels: for those that no other serves, and as the truth of sharing.
#pragma once
#include <span>

#include "caches/fill.h"
#include "caches/interpolate/cache_light.h"
#include "caches/preconvolve.h"

namespace interreflect {

/// How a pixel gets a cache of its own.
struct OwnCaches {
    const Fill& fill;
    const Preconvolve& preconvolve;
    Pyramids pyramids;
    const Intersector& intersector;
    std::uint32_t seed;
};

/// Places, fills and reads a cache for each of the pixels, which all see a surface.
Counts light_by_own_caches(const OwnCaches& own, std::span<const std::uint32_t> pixels, const GBuffer& gbuffer,
                           const Scene& scene, CacheLight& light);

}  // namespace interreflect
