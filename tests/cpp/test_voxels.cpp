#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "math/parallel.h"
#include "voxels/grid.h"
#include "voxels/light_voxels.h"
#include "voxels/prefilter.h"
#include "voxels/voxelize.h"

namespace interreflect {
namespace {

/// A voxel in every cell where `solid` says so, with radiance that names its place.
template <class Solid>
LitVoxels make_lit(const ivec3& cells, const Solid& solid) {
    auto grid = std::make_shared<VoxelGrid>();
    grid->domain = {vec3(0), 1.0f, cells};
    std::vector<std::uint32_t> cell;
    for (std::uint32_t i = 0; i < grid->domain.cell_count(); ++i)
        if (solid(grid->domain.coordinates(i))) cell.push_back(i);
    grid->cell = Buffer<std::uint32_t>(cell.size());
    std::copy(cell.begin(), cell.end(), grid->cell.begin());
    grid->albedo = Buffer<vec3>(cell.size(), vec3(0.5f));
    grid->normal = Buffer<vec3>(cell.size(), vec3(0, 1, 0));
    grid->emission = Buffer<vec3>(cell.size(), vec3(0));
    grid->position = Buffer<vec3>(cell.size(), vec3(0));
    grid->opacity = Buffer<float>(cell.size(), 1.0f);
    LitVoxels lit;
    lit.radiance = Buffer<vec3>(cell.size());
    for (std::size_t i = 0; i < cell.size(); ++i) lit.radiance[i] = vec3(grid->domain.coordinates(cell[i])) + 1.0f;
    lit.grid = std::move(grid);
    return lit;
}

const std::uint16_t* texel(const Pyramid::Level& level, int x, int y, int z, int face = 0) {
    return &level.texels[4 * level.index(x, y, z, face)];
}

TEST(Pyramid, BordersRepeatTheNearestInnerTexelAtEveryLevelAndFace) {
    const auto some = [](const ivec3& at) { return (at.x * 7 + at.y * 5 + at.z * 3) % 4 != 0; };
    VolumeCoverage tent;
    tent.kernel = "tent";
    OctantCoverage columns;
    columns.opacity = "columns";
    for (const ivec3& cells : {ivec3(8, 8, 8), ivec3(7, 3, 5), ivec3(1, 9, 2), ivec3(1, 1, 1)}) {
        const LitVoxels lit = make_lit(cells, some);
        for (const Pyramid& pyramid : {prefilter(SurfaceCoverage{}, lit), prefilter(VolumeCoverage{}, lit),
                                       prefilter(Anisotropic{}, lit), prefilter(OctantCoverage{}, lit),
                                       prefilter(SphericalHarmonicVoxels{}, lit), prefilter(tent, lit), prefilter(columns, lit)})
            for (const auto& level : pyramid.levels)
                for (int face = 0; face < level.faces; ++face)
                    for (int z = -1; z <= level.size.z; ++z)
                        for (int y = -1; y <= level.size.y; ++y)
                            for (int x = -1; x <= level.size.x; ++x) {
                                const ivec3 inner = glm::clamp(ivec3(x, y, z), ivec3(0), level.size - 1);
                                for (int channel = 0; channel < 4; ++channel)
                                    ASSERT_EQ(texel(level, x, y, z, face)[channel],
                                              texel(level, inner.x, inner.y, inner.z, face)[channel]);
                            }
    }
}

TEST(Pyramid, FourLoadsOfTwoNeighboursReachEveryTapInsideTheDomain) {
    const Pyramid pyramid = prefilter(SurfaceCoverage{}, make_lit({5, 3, 2}, [](const ivec3&) { return true; }));
    for (const auto& level : pyramid.levels) {
        const std::size_t texels = level.texels.size() / 4;
        EXPECT_EQ(texels, level.volume());
        EXPECT_EQ(level.index(-1, -1, -1), 0U);
        // The tap with the largest index: b = size - 1, and its neighbours.
        EXPECT_EQ(level.index(level.size.x, level.size.y, level.size.z), texels - 1);
        EXPECT_EQ(level.index(0, 1, 0) - level.index(0, 0, 0), level.row());
        EXPECT_EQ(level.index(0, 0, 1) - level.index(0, 0, 0), level.slice());
    }
}

TEST(Pyramid, TheOpacityOfASolidWorldIsOneAtEveryLevel) {
    for (const ivec3& cells : {ivec3(8, 8, 8), ivec3(6, 5, 3)}) {
        const LitVoxels lit = make_lit(cells, [](const ivec3&) { return true; });
        const Pyramid surface = prefilter(SurfaceCoverage{}, lit);
        constexpr std::uint16_t one = 0x3c00;  // 1 as a half float
        EXPECT_EQ(texel(surface.levels.front(), 0, 0, 0)[3], one);
        // Beyond an odd size lies air: only powers of two are full at every level.
        if (cells.x != 8) continue;
        for (const Pyramid& p :
             {prefilter(VolumeCoverage{}, lit), prefilter(Anisotropic{}, lit), prefilter(SurfaceCoverage{}, lit)})
            for (const auto& level : p.levels) EXPECT_EQ(texel(level, 0, 0, 0)[3], one);
    }
}

TEST(Pyramid, RadianceThatIsNotFiniteIsRefused) {
    LitVoxels lit = make_lit({2, 2, 2}, [](const ivec3&) { return true; });
    lit.radiance[3].y = std::numeric_limits<float>::infinity();
    EXPECT_THROW(prefilter(SurfaceCoverage{}, lit), std::invalid_argument);
}

TEST(Domain, CellsAndCoordinatesAreInverse) {
    const Domain domain{vec3(-3, 1, 2), 0.25f, {5, 7, 3}};
    for (std::uint32_t i = 0; i < domain.cell_count(); ++i) EXPECT_EQ(domain.cell(domain.coordinates(i)), i);
    EXPECT_EQ(domain.to_voxels(domain.to_world({1, 2, 3})), vec3(1, 2, 3));
}

}  // namespace
}  // namespace interreflect
