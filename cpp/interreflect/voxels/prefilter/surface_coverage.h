#pragma once
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "voxels/prefilter/filter_knobs.h"

namespace interreflect {

/// A quarter of the sum, clamped [Rehfeld et al. 2014, 3.1]: a wall one voxel thick stays opaque at every level.
struct SurfaceCoverage : IsotropicKnobs, OpacityKnob {
    bool operator==(const SurfaceCoverage&) const = default;
    static constexpr auto description = describe(
        "SurfaceCoverage", "Opacity is a quarter of the sum of the eight below it, clamped; radiance keeps their mean colour.",
        Source{"Rehfeld et al. 2014", "3.1"}, IsotropicKnobs::params, OpacityKnob::params);
};

Pyramid prefilter(const SurfaceCoverage& technique, const LitVoxels& lit);

}  // namespace interreflect
