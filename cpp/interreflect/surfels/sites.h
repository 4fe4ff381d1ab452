/// Place caches: where do caches of incident radiance stand?
///
///   CacheSites place_caches(const Technique&, const Scene&, const Intersector&);
///
/// LightMap takes the texture coordinates of its charts as well. PixelCaches, the exact counterpart, stands at what the camera
/// sees: pixel_sites(gbuffer).
#pragma once
#include <variant>

#include "surfels/sites/cache_grid.h"
#include "surfels/sites/light_map.h"
#include "surfels/sites/pixel_caches.h"

namespace interreflect {
using PlaceCaches = std::variant<PixelCaches, LightMap, CacheGrid>;
}
