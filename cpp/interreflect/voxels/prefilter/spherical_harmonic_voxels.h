#pragma once
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "voxels/prefilter/filter_knobs.h"

namespace interreflect {

/// Radiance of every voxel in two bands of spherical harmonics (four coefficients a channel), under the opacity of
/// SurfaceCoverage. A surface with normal n that shows F on its front and B on its back looks like (F + B)/2 + 3/4 (B - F) (d .
/// n) along d: the least squares fit to the step between the two hemispheres, which also keeps the flux out of either side, pi F
/// and pi B. Seen head on a surface that is lit on one side is a quarter too bright; where the sum is negative it is black. d and
/// n are directions in the world, in any grid.
struct SphericalHarmonicVoxels : LevelKnobs, OpacityKnob {
    bool operator==(const SphericalHarmonicVoxels&) const = default;
    static constexpr auto description =
        describe("SphericalHarmonicVoxels", "Surface coverage, with radiance in two bands of spherical harmonics.",
                 Source{"Freed 2018, 6; Ramamoorthi and Hanrahan 2001", "projection of a step on the sphere"}, LevelKnobs::params,
                 OpacityKnob::params);
};

Pyramid prefilter(const SphericalHarmonicVoxels& technique, const LitVoxels& lit);

}  // namespace interreflect
