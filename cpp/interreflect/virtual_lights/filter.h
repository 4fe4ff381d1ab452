/// Filter: how much of a virtual light does each pixel see, from what the light's shadow holds?
///
///   void visibility(const Technique&, const ShadowedLight&, const Receivers&, const PerReceiver& irradiance, std::uint32_t seed,
///                   PerReceiver& visible, Counts&);
///
/// A share in [0, 1] for pixels with an irradiance above 0. Exact counterpart: TracedDisk, which looks at no map.
#pragma once
#include <variant>

#include "virtual_lights/filter/pcf.h"
#include "virtual_lights/filter/pcss.h"
#include "virtual_lights/filter/simple_lookup.h"
#include "virtual_lights/filter/traced_disk.h"

namespace interreflect {
using FilterShadows = std::variant<TracedDisk, SimpleLookup, Pcf, Pcss>;
}
