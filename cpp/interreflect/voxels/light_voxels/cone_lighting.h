#pragma once
#include "data/technique.h"
#include "voxels/light_voxels/lighting_task.h"
#include "voxels/march/march_knobs.h"

namespace interreflect {

/// Each voxel is lit at its surface's mean place by its averaged normal; a shadow cone to each light is attenuated by the opacity
/// of the voxels on its way [Rehfeld et al. 2014, 3.1]. No ray is traced: emitters are sampled, with a cone to every sample that
/// ends short of the emitter's own voxels; the environment is what a set of cones about the normal leaves open.
struct ConeLighting : MarchKnobs {
    double half_angle = 2.0;
    int samples = 1;
    int sky_cones = 9;
    bool both_sides = false;

    // As near to TracedLighting as steps of .5, on the same scenes as ConeFill's, with two thirds of the steps.
    ConeLighting() : MarchKnobs{.step = 0.75} {}
    bool operator==(const ConeLighting&) const = default;
    static constexpr auto description = describe(
        "ConeLighting",
        "By the averaged normal, with a shadow cone through the voxels to each light, and cones for the environment.",
        Source{"Rehfeld et al. 2014", "3.1"},
        Param{"half_angle", &ConeLighting::half_angle, "half aperture of the shadow cones", Unit::degrees, between(0, 70)},
        Param{"samples", &ConeLighting::samples, "points on emitters, a voxel and side", Unit::samples, between(1, 4096)},
        Param{"sky_cones", &ConeLighting::sky_cones, "cones over the hemisphere, which see the environment", Unit::none,
              between(3, 256)},
        Param{
            "both_sides", &ConeLighting::both_sides,
            "also light the back of surfaces, which Anisotropic and OctantCoverage look at; else it passes for as bright as the "
            "front"},
        MarchKnobs::params);
};

LitVoxels light_voxels(const ConeLighting& technique, const LightingTask& task);

}  // namespace interreflect
