#pragma once
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"

namespace interreflect {

/// Uniform samples over every triangle, averaged in the cell they fall into [Rehfeld et al. 2014, 3.1].
struct SurfaceSampling {
    double spacing = 0.5;

    bool operator==(const SurfaceSampling&) const = default;
    static constexpr auto description =
        describe("SurfaceSampling", "Uniform samples over every triangle, averaged in the cell they fall into.",
                 Source{"Rehfeld et al. 2014", "3.1"},
                 Param{"spacing", &SurfaceSampling::spacing, "largest distance between neighbouring samples of a triangle",
                       Unit::voxels, between(1.0 / 16.0, 1.0)});
};

VoxelGrid voxelize(const SurfaceSampling& technique, const Scene& scene, const Domain& domain);

}  // namespace interreflect
