#pragma once
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"

namespace interreflect {

/// Every cell that a triangle overlaps, by the separating axes of triangle and box [Akenine-Moeller 2001]; means over the area
/// inside the cell.
struct ExactOverlap {
    int samples = 16;

    bool operator==(const ExactOverlap&) const = default;
    static constexpr auto description = describe(
        "ExactOverlap", "Every cell that a triangle overlaps, by separating axes; means over the triangle's part in the cell.",
        Source{"Akenine-Moeller 2001"},
        Param{"samples", &ExactOverlap::samples, "texture samples on a face of a voxel's area", Unit::samples, between(1, 4096)});
};

VoxelGrid voxelize(const ExactOverlap& technique, const Scene& scene, const Domain& domain);

}  // namespace interreflect
