#pragma once
#include "data/scene.h"
#include "data/technique.h"
#include "data/virtual_lights.h"

namespace interreflect {

/// Virtual lights shine through everything, whatever the filter.
struct Unshadowed {
    bool operator==(const Unshadowed&) const = default;
    static constexpr auto description =
        describe("Unshadowed", "Virtual lights shine through everything.", Source{"Prutkin et al. 2012"});
};

inline LightShadows shadow_lights(const Unshadowed&, const VirtualLights&, const SurfacePoints&, const Scene&) { return {}; }

}  // namespace interreflect
