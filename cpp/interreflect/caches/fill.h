/// Fill: which radiance arrives at every cache, over the hemisphere about its normal?
///
///   FilledCaches fill(const Technique&, std::shared_ptr<const CachePlaces>, Pyramids, const Scene&, const Intersector&, seed);
///
/// Radiance of light that surfaces reflect, from the voxels; of an environment, in `sky`, and what is open. Exact counterpart:
/// TracedFill.
#pragma once
#include <variant>

#include "caches/fill/cone_fill.h"
#include "caches/fill/traced_fill.h"

namespace interreflect {
using Fill = std::variant<TracedFill, ConeFill>;
}
