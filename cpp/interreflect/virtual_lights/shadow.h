/// Shadow: what does each virtual light see?
///
///   LightShadows shadow_lights(const Technique&, const VirtualLights&, const SurfacePoints&, const Scene&);
///
/// How it is looked up for a pixel is filter_shadows. Exact counterpart: TracedVisibility.
#pragma once
#include <variant>

#include "virtual_lights/shadow/imperfect_shadow_maps.h"
#include "virtual_lights/shadow/traced_visibility.h"
#include "virtual_lights/shadow/unshadowed.h"

namespace interreflect {
using ShadowLights = std::variant<TracedVisibility, ImperfectShadowMaps, Unshadowed>;
}
