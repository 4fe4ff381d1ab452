/// What every technique of light_voxels works on.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "data/scene.h"
#include "data/voxel_grid.h"
#include "shading/lights.h"
#include "visibility/intersector.h"

namespace interreflect {

/// What the last frame left: null where there was none, or where the technique does not look at it.
struct VoxelHistory {
    std::shared_ptr<const LitVoxels> lit;
    std::shared_ptr<const Pyramid> pyramid;  // made from `lit`
};

struct LightingTask {
    const Scene& scene;
    const Intersector& intersector;
    const LightSampler& lights;
    std::shared_ptr<const VoxelGrid> voxels;     // to be lit
    std::shared_ptr<const VoxelGrid> occluders;  // every voxel of the scene: `voxels`, or more
    VoxelHistory last;
    std::uint32_t seed = 0;
    std::vector<std::shared_ptr<const VoxelGrid>> others = {};  // of the scene's other parts, which block light too
};

}  // namespace interreflect
