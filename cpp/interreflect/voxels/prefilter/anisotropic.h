#pragma once
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "voxels/prefilter/filter_knobs.h"

namespace interreflect {

/// Six faces: pairs composited front to back along each direction, then averaged [Crassin et al. 2011, 4.2]. The two sides of a
/// voxel's surface keep their own radiance from the second level on.
struct Anisotropic : LevelKnobs {
    bool operator==(const Anisotropic&) const = default;
    static constexpr auto description =
        describe("Anisotropic", "Six faces, each composited front to back along its direction, then averaged.",
                 Source{"Crassin et al. 2011", "anisotropic voxels"}, LevelKnobs::params);
};

Pyramid prefilter(const Anisotropic& technique, const LitVoxels& lit);

}  // namespace interreflect
