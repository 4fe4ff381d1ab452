/// Distribute: where in the picture do radiance caches stand?
///
///   CachePlaces distribute(const Technique&, const GBuffer&, const Scene&, const CachePlaces* last);
///
/// One cache a cluster of pixels, at the pixel of it that stands best for the others (tile_clusters.h); ReuseCaches may have none
/// there, or several. `last` is what the same
/// technique returned for the frame before (ReuseCaches looks at it); null: there is none. Exact counterpart: CachePerPixel.
#pragma once
#include <variant>

#include "caches/distribute/cache_per_pixel.h"
#include "caches/distribute/clustered.h"
#include "caches/distribute/cube_face_clustered.h"
#include "caches/distribute/equidistant.h"
#include "caches/distribute/reuse_caches.h"

namespace interreflect {
using Distribute = std::variant<CachePerPixel, Clustered, CubeFaceClustered, Equidistant, ReuseCaches>;
}
