/// Interpolate: what do the pixels receive and reflect, from the caches around them?
///
///   CacheLight interpolate(const Technique&, const ConvolvedCaches&, const GBuffer&, const Scene&, const OwnCaches&);
///
/// Pixels that no cache serves are counted, and lit as the technique says. Exact counterpart: Evaluated, for which the caches
/// that are given do not matter: neither how they are distributed nor how they are shared.
#pragma once
#include <variant>

#include "caches/interpolate/evaluated.h"
#include "caches/interpolate/gather.h"
#include "caches/interpolate/splat.h"

namespace interreflect {
using Interpolate = std::variant<Evaluated, Gather, Splat>;
}
