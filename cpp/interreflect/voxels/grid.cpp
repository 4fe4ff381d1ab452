#include "voxels/grid.h"

#include <algorithm>

namespace interreflect {

Domain place(const Grid& grid, const Scene& scene, const Camera*) {
    const auto bounds = scene.geometry->bounds();
    const vec3 extent = bounds.upper - bounds.lower;
    if (!(min_component(extent) >= 0.0f) || !(max_component(extent) > 0.0f)) return {};
    Domain domain;
    const auto resolution = static_cast<float>(grid.resolution);
    domain.voxel_size = max_component(extent) / (resolution - 1.0f);
    for (int axis = 0; axis < 3; ++axis) {
        // The tolerance keeps an extent that is a whole number of voxels but for rounding from taking one more.
        const float voxels = std::ceil(extent[axis] / domain.voxel_size + 1.0f - 1e-3f);
        domain.cells[axis] = std::clamp(static_cast<int>(voxels), 1, grid.resolution);
    }
    const vec3 centre = bounds.lower + 0.5f * extent;
    domain.lower = centre - vec3(domain.cells) * (0.5f * domain.voxel_size);
    return domain;
}

}  // namespace interreflect
