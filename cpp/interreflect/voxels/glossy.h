/// Glossy: what does the pixels' glossy lobe reflect towards the camera, of the voxels and of the environment?
///
///   GlossyLight glossy(const Technique&, Pyramids, const GBuffer&, const Scene&, const Intersector&, seed);
///
/// Only pixels with a specular reflectance are visited. The G-buffer says which lobe they have (stage shade). Exact counterpart:
/// TracedRays.
#pragma once
#include <variant>

#include "voxels/glossy/glossy_cone.h"
#include "voxels/march/traced_rays.h"

namespace interreflect {
using Glossy = std::variant<TracedRays, GlossyCone>;
}
