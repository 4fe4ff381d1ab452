/// Traced shadows: rays to every light.
#pragma once
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/technique.h"
#include "direct/direct_light.h"
#include "shading/lights.h"
#include "visibility/intersector.h"

namespace interreflect {

/// A ray to every point, spot and directional light: exact for them. Emitters by stratified samples: noise falls with their
/// number; where the surface is glossy half of the rays follow its lobe, weighted by the balance heuristic [Veach 1997, 9.2].
struct TracedShadows {
    int samples = 4;

    bool operator==(const TracedShadows&) const = default;
    static constexpr auto description = describe(
        "TracedShadows", "A ray to every point, spot and directional light; stratified samples of the emitters.",
        Source{"Veach 1997", "section 9.2"},
        Param{"samples", &TracedShadows::samples, "points on emitters for every pixel", Unit::samples, between(1, 65536)});
};
DirectLight shadow(const TracedShadows& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& gbuffer, std::uint32_t seed);

/// Adds what the pixels reflect of the emitters' light to `light`, by `samples` stratified points each.
void add_emitters(DirectLight& light, int samples, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                  const GBuffer& gbuffer, std::uint32_t seed);

}  // namespace interreflect
