#pragma once
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "voxels/prefilter/filter_knobs.h"

namespace interreflect {

/// Surface coverage of eight volumes, one for every octant of directions: each voxel shows the side that an eye looking that way
/// sees, and what stands in front hides what stands behind. A cone reads the one volume of its own octant, so it costs no more
/// than without sides; a wall along the grid shows every cone the right side, and stays opaque at every level as under
/// SurfaceCoverage.
struct OctantCoverage : LevelKnobs, OpacityKnob {
    bool operator==(const OctantCoverage&) const = default;
    static constexpr auto description = describe(
        "OctantCoverage", "Surface coverage, with the colour that is seen along each of eight directions.",
        Source{"Rehfeld et al. 2014, 3.1; Crassin et al. 2011", "anisotropic voxels"}, LevelKnobs::params, OpacityKnob::params);
};

Pyramid prefilter(const OctantCoverage& technique, const LitVoxels& lit);

}  // namespace interreflect
