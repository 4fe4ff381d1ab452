/// Averages noisy light over neighbouring pixels of the same surface.
#pragma once
#include "data/buffer.h"
#include "data/gbuffer.h"

namespace interreflect {

/// A mean over (2 radius + 1)^2 pixels, along rows and then along columns. A neighbour counts by how nearly it lies in the
/// pixel's tangent plane, measured in widths of the pixel, and faces the same way; pixels without a surface never do.
Buffer<vec3> filter_along_surfaces(const Buffer<vec3>& values, const GBuffer& gbuffer, int radius);

}  // namespace interreflect
