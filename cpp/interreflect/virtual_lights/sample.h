/// Sample: which texels of the reflective shadow maps become virtual lights, or seeds of clusters?
///
///   VirtualLights sample_lights(const Technique&, const LightMaps&, std::uint32_t seed);
///
/// As many lights as the technique asks for, fewer where fewer texels send light on. Their fluxes sum up to what the maps send
/// on, exactly or in expectation. Exact counterpart: EveryRsmPixel.
#pragma once
#include <variant>

#include "virtual_lights/sample/every_rsm_pixel.h"
#include "virtual_lights/sample/halton_lights.h"

namespace interreflect {
using SampleLights = std::variant<EveryRsmPixel, HaltonLights>;
}
