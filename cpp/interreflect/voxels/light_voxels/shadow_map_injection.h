#pragma once
#include <string>

#include "data/technique.h"
#include "voxels/light_voxels/lighting_task.h"

namespace interreflect {

/// What each light sees, texel by texel, is brought to the voxel that holds it [Freed 2018, 4.3]; only those voxels get light.
///
/// Such a voxel's side gets the irradiance at its point, times the share of 3 x 3 texels about it that are lit: so a voxel that a
/// shadow's border crosses is lit or not by where its point lies, and light neither grows nor shrinks. As the map gets finer it
/// becomes TracedLighting's. A map whose texels are wider than the voxels leaves gaps, as the paper says. Emitters and
/// environment have no map: they are sampled and traced as TracedLighting does.
///
/// The paper injects the bare base colour, without the light's colour, cosine or 1/pi (ERRATA): `base_colour`.
struct ShadowMapInjection {
    int size = 512;
    std::string radiance = "lit";
    int samples = 1;
    bool both_sides = false;

    bool operator==(const ShadowMapInjection&) const = default;
    static constexpr auto description = describe(
        "ShadowMapInjection",
        "What each light's shadow map meets lights the voxel there; emitters and environment by traced samples.",
        Source{"Freed 2018", "4.3"},
        Param{"size", &ShadowMapInjection::size,
              "texels on a side of a map: of a spot or directional light, or each of a cube's six sides", Unit::texels,
              between(1, 16384)},
        Param{"radiance", &ShadowMapInjection::radiance,
              "`lit`: albedo / pi times irradiance; `base_colour`: the bare albedo of whatever a light meets, as printed",
              Unit::none, one_of("lit|base_colour")},
        Param{"samples", &ShadowMapInjection::samples, "samples of the emitters, and of the environment, a voxel and side",
              Unit::samples, between(1, 4096)},
        Param{
            "both_sides", &ShadowMapInjection::both_sides,
            "also light the back of surfaces, which Anisotropic and OctantCoverage look at; else it passes for as bright as the "
            "front"});
};

LitVoxels light_voxels(const ShadowMapInjection& technique, const LightingTask& task);

}  // namespace interreflect
