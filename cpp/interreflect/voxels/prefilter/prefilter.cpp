#include "voxels/prefilter.h"

#include "voxels/prefilter/levels.h"

namespace interreflect {

Pyramid prefilter(const VolumeCoverage& t, const LitVoxels& lit) { return build_isotropic(Coverage::volume, false, t, lit); }
Pyramid prefilter(const SurfaceCoverage& t, const LitVoxels& lit) {
    return build_isotropic(Coverage::surface, t.opacity == "columns", t, lit);
}
Pyramid prefilter(const SphericalHarmonicVoxels& t, const LitVoxels& lit) {
    return build_harmonics(t.opacity == "columns", t, lit);
}
Pyramid prefilter(const Anisotropic& t, const LitVoxels& lit) { return build_anisotropic(t, lit); }
Pyramid prefilter(const OctantCoverage& t, const LitVoxels& lit) { return build_octants(t.opacity == "columns", t, lit); }

}  // namespace interreflect
