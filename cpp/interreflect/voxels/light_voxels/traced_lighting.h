#pragma once
#include "data/technique.h"
#include "voxels/light_voxels/lighting_task.h"

namespace interreflect {

/// A shadow ray against the triangles to every delta light, and stratified samples of emitters and environment, from a point of
/// each voxel's surface with that point's normal.
struct TracedLighting {
    int samples = 1;
    bool both_sides = false;

    bool operator==(const TracedLighting&) const = default;
    static constexpr auto description =
        describe("TracedLighting",
                 "A shadow ray against the triangles to every delta light, and stratified samples of emitters and environment.",
                 Source{"Rehfeld et al. 2014", "3.1, with traced shadows"},
                 Param{"samples", &TracedLighting::samples, "samples of the emitters, and of the environment, a voxel and side",
                       Unit::samples, between(1, 4096)},
                 Param{"both_sides", &TracedLighting::both_sides,
                       "also light the back of surfaces, which Anisotropic and OctantCoverage look at; else it passes for as "
                       "bright as the front"});
};

LitVoxels light_voxels(const TracedLighting& technique, const LightingTask& task);

}  // namespace interreflect
