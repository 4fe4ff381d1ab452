/// Surfels as the pixels of a picture: whatever lights pixels lights them [Jendersie et al. 2016, 3].
#pragma once
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/surfels.h"

namespace interreflect {

/// Row by row, diffuse, each seen along its normal; textures are filtered by the surfel's area. The last row ends with pixels
/// that see nothing.
GBuffer surfel_pixels(const Surfels& surfels, const Scene& scene);

}  // namespace interreflect
