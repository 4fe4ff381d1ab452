/// Evaluate: what do pixels get from caches of incident radiance?
///
///   SurfelLight evaluate(const Technique&, const LightCaches&, const CacheSites&, const GBuffer&, const Scene&);
///
/// Interpolated between the caches about each pixel (evaluate/cache_finder.h). DirectLinks, the exact counterpart, takes the
/// links and what they bring in place of the caches' light.
#pragma once
#include <variant>

#include "surfels/evaluate/direct_links.h"
#include "surfels/evaluate/spherical_harmonic_lobes.h"

namespace interreflect {
using Evaluate = std::variant<DirectLinks, SphericalHarmonicLobes>;
}
