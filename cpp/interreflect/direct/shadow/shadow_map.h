/// Shadow maps: depth seen from the light, compared at the pixels.
#pragma once
#include <vector>

#include "direct/shadow/traced_shadows.h"
#include "visibility/depth_map.h"

namespace interreflect {

/// A depth map for every light: orthographic over the scene's bounds (directional), perspective (spot), the six sides of a cube
/// (point, and spots wider than 75 degrees); 3 x 3 comparisons, averaged [Williams 1978; Reeves et al. 1987]. Emitters have no
/// map: they are sampled and traced as TracedShadows does.
struct ShadowMap {
    int size = 1024;
    // Receivers are compared at their tangent plane, so flat ones need no bias; a sphere departs from its plane by the sagitta
    // d^2 / 2r within the d = 1.5 sqrt(2) texels that the comparison reaches: one texel for every radius above 2.25 texels.
    double bias = 1.0;
    int samples = 4;

    bool operator==(const ShadowMap&) const = default;
    static constexpr auto description = describe(
        "ShadowMap", "Depth seen from every light, compared 3 x 3; emitters by traced samples.",
        Source{"Reeves et al. 1987", "Rendering antialiased shadows with depth maps"},
        Param{"size", &ShadowMap::size, "texels on a side of a map", Unit::texels, between(1, 16384)},
        Param{"bias", &ShadowMap::bias, "how far below the map's depth a point still counts as lit, beyond its tangent plane",
              Unit::texels, between(0, 1000)},
        Param{"samples", &ShadowMap::samples, "points on emitters for every pixel", Unit::samples, between(1, 65536)});
};
/// The maps of all point, spot and directional lights, as LightSampler counts them: what a frame's pixels and all else that it
/// lights can share.
struct ShadowMaps {
    std::vector<DepthMaps> lights;
    Counts counts;

    std::size_t bytes() const;
};
ShadowMaps shadow_maps(const ShadowMap& technique, const Scene& scene, const Intersector& intersector);

/// std::invalid_argument for maps of another number of lights.
DirectLight shadow(const ShadowMap& technique, const ShadowMaps& maps, const Scene& scene, const Intersector& intersector,
                   const LightSampler& lights, const GBuffer& gbuffer, std::uint32_t seed);
/// By maps of its own.
DirectLight shadow(const ShadowMap& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& gbuffer, std::uint32_t seed);

}  // namespace interreflect
