#pragma once
#include <string>

#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"

namespace interreflect {

/// The vertices of tessellated triangles, averaged in the cell they fall into [Freed 2018, 4.1.2].
///
/// An edge is cut into ceil(length / (spacing voxel size)) parts, the inside into ceil(largest altitude / (spacing voxel size)).
/// The paper's outer level, |E| / (E / ||E|| voxel size), divides by a vector: its numerator must be the edge's length. A
/// triangle within one voxel is one sample.
///
/// Splitting cuts the longest edge in half where it needs too high a level, and where the triangle is longer than 2.5 times its
/// width: the altitude says little about the distance of the rows of vertices in a narrow triangle, nor in an obtuse one of those
/// in a row. A triangle no wider than the spacing is not split for that: the vertices of its edges are enough.
struct Tessellation {
    double spacing = 0.5;
    int max_level = 64;
    bool split = true;
    std::string levels = "warped";

    bool operator==(const Tessellation&) const = default;
    static constexpr auto description = describe(
        "Tessellation", "The vertices of triangles tessellated down to voxels, averaged in the cell they fall into.",
        Source{"Freed 2018", "4.1.2"},
        Param{"spacing", &Tessellation::spacing, "largest distance of vertices along an edge; the paper's is 1, and leaves holes",
              Unit::voxels, between(1.0 / 16.0, 2.0)},
        Param{"max_level", &Tessellation::max_level, "most parts that an edge is cut into; graphics processors have 64",
              Unit::none, between(1, 1024)},
        Param{"split", &Tessellation::split,
              "split triangles that need a higher level, or are narrow; without, large triangles have holes"},
        Param{"levels", &Tessellation::levels,
              "warped: edges are measured in the voxels they pass, after triangles are cut where a warp bends them and where "
              "nested "
              "grids end; uniform: whole triangles in unwarped voxels of the finest grid, as printed",
              Unit::none, one_of("warped|uniform")});
};

VoxelGrid voxelize(const Tessellation& technique, const Scene& scene, const Domain& domain);

}  // namespace interreflect
