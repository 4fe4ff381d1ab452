#pragma once
#include <string>

#include "data/gbuffer.h"
#include "data/light_caches.h"
#include "data/scene.h"
#include "data/technique.h"
#include "surfels/evaluate/surfel_light.h"

namespace interreflect {

/// Dot products of the interpolated incident radiance with the cosine about the normal, and with a power of the cosine for the
/// glossy lobe [Jendersie et al. 2016, 3.2 and appendix B]. An SH cache knows no light's direction, so there is no half vector:
/// the lobe stands about the mirrored view or the lobe's own mean, with the power whose mean cosine is the lobe's (ERRATA).
/// Where the sum is negative, the pixel is black.
struct SphericalHarmonicLobes {
    int chrominance_bands = 0;
    std::string window = "none";

    bool operator==(const SphericalHarmonicLobes&) const = default;
    static constexpr auto description = describe(
        "SphericalHarmonicLobes", "Diffuse and glossy lobes in spherical harmonics, against the caches' radiance.",
        Source{"Jendersie et al. 2016", "3.2, 4.8, appendix B"},
        Param{"chrominance_bands", &SphericalHarmonicLobes::chrominance_bands,
              "of the caches' chrominance; 0: as many as of their luma", Unit::none, between(0, 8)},
        Param{"window", &SphericalHarmonicLobes::window, "that weakens the caches' higher bands, so that small lights ring less",
              Unit::none, one_of("none|hanning|lanczos")});
};

SurfelLight evaluate(const SphericalHarmonicLobes& technique, const LightCaches& caches, const CacheSites& sites,
                     const GBuffer& gbuffer, const Scene& scene);

}  // namespace interreflect
