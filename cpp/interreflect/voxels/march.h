/// March: how much light arrives over the hemisphere at the pixels, from the voxels and through the openings between them?
///
///   GatheredLight march(const Technique&, Pyramids, const GBuffer&, const Scene&, const Intersector&, const Share&, seed);
///
/// Irradiance is that about the shading normal. Emission is not in the voxels, so light from emitters is the `shadow` stage's.
/// What leaves the voxels unblocked meets the environment: `sky`, and `occlusion`, the share that does not. Exact counterpart:
/// TracedRays.
#pragma once
#include <variant>

#include "voxels/march/diffuse_cones.h"
#include "voxels/march/traced_rays.h"

namespace interreflect {
using March = std::variant<TracedRays, DiffuseCones>;
}
