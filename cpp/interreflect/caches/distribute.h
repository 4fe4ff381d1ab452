/// Distribute: where in the picture do radiance caches stand?
///
///   CachePlaces distribute(const Technique&, const GBuffer&, const Scene&, const CachePlaces* last);
///
/// At most one cache a cluster of pixels, at the pixel of it that stands best for the others (place.h). `last` is what the same
/// technique returned for the frame before; null: there is none, or it does not matter. Exact counterpart: CachePerPixel.
#pragma once
#include <variant>

#include "caches/distribute/cache_per_pixel.h"
#include "caches/distribute/clustered.h"
#include "caches/distribute/cube_face_clustered.h"
#include "caches/distribute/equidistant.h"

namespace interreflect {
using Distribute = std::variant<CachePerPixel, Clustered, CubeFaceClustered, Equidistant>;
}
