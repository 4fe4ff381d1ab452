/// Sums of links, a vector of coefficients or of links at a time.
#pragma once
#include "data/light_caches.h"
#include "data/surfels.h"

namespace interreflect {

/// Caches [begin, end) of links with coefficients.
void light_projected(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches);
/// The same of cones.
void light_cones(const CacheLinks& links, const NodeLight& light, std::size_t begin, std::size_t end, LightCaches& caches);

/// Writes a cache: `red`, `green`, `blue` have bands^2 coefficients each, in arrays of 64 aligned to 64 bytes.
void store_cache(LightCaches& caches, std::size_t cache, const float* red, const float* green, const float* blue);

}  // namespace interreflect
