/// Prefilter: what does a box of voxels look like from afar?
///
///   Pyramid prefilter(const Technique&, const LitVoxels&);
///
/// The finest level holds the radiance of every voxel's front (OctantCoverage: of the side that is seen;
/// SphericalHarmonicVoxels: of both), premultiplied by its
/// opacity; data/voxel_grid.h describes the layout. No exact counterpart: TracedRays of the march bypasses it.
#pragma once
#include <variant>

#include "voxels/prefilter/anisotropic.h"
#include "voxels/prefilter/octant_coverage.h"
#include "voxels/prefilter/spherical_harmonic_voxels.h"
#include "voxels/prefilter/surface_coverage.h"
#include "voxels/prefilter/volume_coverage.h"

namespace interreflect {
using Prefilter = std::variant<VolumeCoverage, SurfaceCoverage, Anisotropic, OctantCoverage, SphericalHarmonicVoxels>;
}
