/// The sky through the openings that cones left.
#pragma once
#include <span>

#include "data/gbuffer.h"
#include "data/technique.h"
#include "direct/direct_light.h"

namespace interreflect {

/// The march's cones that leave the scene look up the environment; this stage turns what they gathered into reflected light. It
/// costs no rays of its own.
struct ConeSky {
    bool operator==(const ConeSky&) const = default;
    static constexpr auto description =
        describe("ConeSky", "What the march's cones leave open of the environment.", Source{"Rehfeld et al. 2014"});
};
/// `irradiance`: of the environment, a pixel each; `glossy`: radiance of the environment that the lobe reflects, or empty.
DirectLight sky(const ConeSky& technique, const GBuffer& gbuffer, std::span<const vec3> irradiance, std::span<const vec3> glossy);

}  // namespace interreflect
