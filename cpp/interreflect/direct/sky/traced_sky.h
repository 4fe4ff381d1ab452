/// The sky by rays.
#pragma once
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/technique.h"
#include "direct/direct_light.h"
#include "shading/lights.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Stratified rays from every pixel: in proportion to the cosine (and to the lobe, where the surface is glossy); under an image
/// another ray each in proportion to its luminance, both weighted by the balance heuristic [Veach 1997, 9.2]. Unbiased with
/// filter_radius = 0. A wider filter averages the irradiance, not the picture, over neighbours that lie in the pixel's tangent
/// plane and face the same way; textures and glossy reflections stay sharp.
struct TracedSky {
    int samples = 4;
    int filter_radius = 0;

    bool operator==(const TracedSky&) const = default;
    static constexpr auto description = describe(
        "TracedSky", "Stratified rays to the environment; irradiance filtered along surfaces if so wished.",
        Source{"Veach 1997", "section 9.2"},
        Param{"samples", &TracedSky::samples, "rays for every pixel and kind of reflection", Unit::samples, between(1, 65536)},
        Param{"filter_radius", &TracedSky::filter_radius,
              "pixels to each side over which irradiance is averaged along the surface; 0: unfiltered, unbiased", Unit::pixels,
              between(0, 64)});
};
DirectLight sky(const TracedSky& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                const GBuffer& gbuffer, std::uint32_t seed);

}  // namespace interreflect
