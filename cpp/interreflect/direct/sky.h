/// Sky: what do the pixels reflect of the environment's light?
///
///   DirectLight sky(const TracedSky&, const Scene&, const Intersector&, const LightSampler&, const GBuffer&, seed);
///   DirectLight sky(const ConeSky&, const GBuffer&, gathered sky, glossy sky);
///
/// The environment seen directly is the G-buffer's emission and no part of it. Exact counterpart: TracedSky.
#pragma once
#include <variant>

#include "direct/sky/cone_sky.h"
#include "direct/sky/traced_sky.h"

namespace interreflect {
using Sky = std::variant<TracedSky, ConeSky>;
}
