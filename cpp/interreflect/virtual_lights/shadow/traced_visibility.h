#pragma once
#include "data/scene.h"
#include "data/technique.h"
#include "data/virtual_lights.h"

namespace interreflect {

/// Nothing is stored: every lookup of filter_shadows is a ray from the light.
struct TracedVisibility {
    bool operator==(const TracedVisibility&) const = default;
    static constexpr auto description =
        describe("TracedVisibility", "Every lookup of a light's shadow is a ray.", Source{"Keller 1997"});
};

inline LightShadows shadow_lights(const TracedVisibility&, const VirtualLights&, const SurfacePoints&, const Scene&) {
    LightShadows shadows;
    shadows.kind = LightShadows::Kind::traced;
    return shadows;
}

}  // namespace interreflect
