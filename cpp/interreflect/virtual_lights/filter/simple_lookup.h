#pragma once
#include "data/technique.h"
#include "virtual_lights/filter/shadowed_light.h"

namespace interreflect {

/// One lookup towards the pixel: lit or not.
struct SimpleLookup {
    bool operator==(const SimpleLookup&) const = default;
    static constexpr auto description =
        describe("SimpleLookup", "One lookup of a light's shadow: lit or not.", Source{"Ritschel et al. 2008"});
};
void visibility(const SimpleLookup&, const ShadowedLight& light, const Receivers& receivers, const PerReceiver& irradiance,
                std::uint32_t seed, PerReceiver& visible, Counts& counts);

}  // namespace interreflect
