/// Where the voxels stand.
#pragma once
#include "data/camera.h"
#include "data/domain.h"
#include "data/scene.h"
#include "data/technique.h"
#include "voxels/region.h"
#include "voxels/warp.h"

namespace interreflect {

/// The voxels' number, region and spread.
struct Grid {
    int resolution = 128;
    WarpTechnique warp = Linear{};
    int cascades = 1;
    Region region = SceneBounds{};

    bool operator==(const Grid&) const = default;
    static constexpr auto description =
        describe("Grid", "Where voxels stand, how many, and how they are spread.",
                 Source{"Rehfeld et al. 2014; Freed 2018", "4; 4.6, 5.4"},
                 Param{"resolution", &Grid::resolution, "voxels along the longest side", Unit::voxels, between(2, 1024)},
                 Param{"warp", &Grid::warp, "how the voxels are spread over space"},
                 Param{"cascades", &Grid::cascades,
                       "grids of `resolution` voxels nested about the camera, each half as wide as the next: every point has one "
                       "finest voxel",
                       Unit::none, between(1, Domain::most_cascades)},
                 Param{"region", &Grid::region, "which part of space they cover; view volumes bring their own"});
};

/// The domain of a grid. Over the scene's bounds: `resolution` voxels along the longest side, as few as hold them along the
/// others, centred. Outer walls lie half a voxel inside (along the longest side; up to one along the others), never on a face. An
/// empty scene gets one voxel. `aspect`: the picture's width over its height.
/// Throws std::invalid_argument for a box without extent, far not above near, cascades with a warp, a view volume with a region;
/// and where a camera is needed and missing.
Domain place(const Grid& grid, const Scene& scene, const Camera* camera = nullptr, float aspect = 1.0f);

}  // namespace interreflect
