/// Where the voxels stand.
#pragma once
#include "data/camera.h"
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"

namespace interreflect {

/// Cubic voxels over the scene's bounds, any aspect.
struct Grid {
    int resolution = 128;

    bool operator==(const Grid&) const = default;
    static constexpr auto description = describe(
        "Grid", "Cubic voxels over the scene's bounds, half a voxel of air around them.", Source{"Rehfeld et al. 2014", "4"},
        Param{"resolution", &Grid::resolution, "voxels along the longest side", Unit::voxels, between(2, 1024)});
};

/// The domain: `resolution` voxels along the longest side of the scene's bounds, as few as hold them along the others, centred.
/// Outer walls lie half a voxel inside (along the longest side; up to one along the others), never on a face. An empty scene gets
/// one voxel.
Domain place(const Grid& grid, const Scene& scene, const Camera* camera = nullptr);

}  // namespace interreflect
