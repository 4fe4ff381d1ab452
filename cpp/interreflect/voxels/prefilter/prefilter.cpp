#include "voxels/prefilter.h"

#include "voxels/prefilter/levels.h"

namespace interreflect {

Pyramid prefilter(const VolumeCoverage&, const LitVoxels& lit) { return build_isotropic(Coverage::volume, lit); }
Pyramid prefilter(const SurfaceCoverage&, const LitVoxels& lit) { return build_isotropic(Coverage::surface, lit); }
Pyramid prefilter(const Anisotropic&, const LitVoxels& lit) { return build_anisotropic(lit); }
Pyramid prefilter(const OctantCoverage&, const LitVoxels& lit) { return build_octants(lit); }

}  // namespace interreflect
