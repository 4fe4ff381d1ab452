#pragma once
#include <string>

#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"

namespace interreflect {

/// Every triangle rasterized along its dominant axis, as a graphics processor does [Freed 2018, 4.1.1].
///
/// A fragment is generated where any of a pixel's samples is covered, at the centroid of those that are; it stands for as many
/// shares of the pixel's surface as samples are covered. Samples on an edge belong to the triangle at their right or above, so
/// triangles that share an edge and a dominant axis neither overlap nor leave a crack.
struct Rasterization {
    int samples = 4;
    std::string conservative = "none";
    int oversampling = 1;
    std::string blend = "mean";

    bool operator==(const Rasterization&) const = default;
    static constexpr auto description = describe(
        "Rasterization", "Every triangle rasterized along its dominant axis; a fragment is put into the cell it falls into.",
        Source{"Freed 2018", "4.1.1"},
        Param{"samples", &Rasterization::samples, "samples of a pixel, in the standard pattern of 1, 2, 4 or 8", Unit::samples,
              between(1, 8)},
        Param{"conservative", &Rasterization::conservative,
              "full: fragments wherever the triangle touches a pixel, in every cell that its plane crosses there within the "
              "triangle's depths",
              Unit::none, one_of("none|full")},
        Param{"oversampling", &Rasterization::oversampling, "pixels along the edge of a voxel", Unit::pixels, between(1, 8)},
        Param{"blend", &Rasterization::blend,
              "mean: albedo and normal averaged by area; max: those of the triangle of the most contrasting albedo "
              "[Doghramachi 2013]",
              Unit::none, one_of("mean|max")});
};

VoxelGrid voxelize(const Rasterization& technique, const Scene& scene, const Domain& domain);

}  // namespace interreflect
