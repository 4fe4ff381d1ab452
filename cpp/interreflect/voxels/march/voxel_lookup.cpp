#include "voxels/march/voxel_lookup.h"

#include <algorithm>
#include <glm/gtc/packing.hpp>
#include <limits>

namespace interreflect {
namespace {

/// Opacity of a voxel: nested grids are the first levels.
float opacity(const Pyramid& pyramid, int grid, const ivec3& at) {
    const auto& level = pyramid.levels[static_cast<std::size_t>(grid)];
    return glm::unpackHalf1x16(level.texels[4 * level.index(at.x, at.y, at.z) + 3]);
}

/// The occupied cell among `cell` and the 26 around it that is nearest to `point` (voxels); false where there is none.
bool nearest_occupied(const Pyramid& pyramid, int grid, const vec3& point, ivec3& cell) {
    if (opacity(pyramid, grid, cell) > 0.0f) return true;
    const ivec3 centre = cell;
    float least = std::numeric_limits<float>::infinity();
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const ivec3 at = centre + ivec3(x, y, z);
                if (glm::any(glm::lessThan(at, ivec3(0))) || glm::any(glm::greaterThanEqual(at, pyramid.domain.cells))) continue;
                const vec3 away = vec3(at) + 0.5f - point;
                if (glm::dot(away, away) >= least || opacity(pyramid, grid, at) <= 0.0f) continue;
                least = glm::dot(away, away);
                cell = at;
            }
    return least < std::numeric_limits<float>::infinity();
}

vec3 texel_radiance(const Pyramid& pyramid, int grid, const ivec3& at) {
    const auto& level = pyramid.levels[static_cast<std::size_t>(grid)];
    const std::uint16_t* texel = level.texels.data() + 4 * level.index(at.x, at.y, at.z);
    return vec3(glm::unpackHalf1x16(texel[0]), glm::unpackHalf1x16(texel[1]), glm::unpackHalf1x16(texel[2])) *
           (pyramid.scale / glm::unpackHalf1x16(texel[3]));
}

/// The side of the voxel that faces most as the surface that was seen does. In nested grids a texel may be opaque by what a finer
/// grid holds: it shows what its texel does.
vec3 side_radiance(const Pyramid& pyramid, int grid, const ivec3& at, const vec3& seen_normal) {
    const LitVoxels& lit = *pyramid.lit;
    const auto& cells = lit.grid->cell;
    const std::uint32_t cell = pyramid.domain.cell(at, grid);
    const auto found = std::lower_bound(cells.begin(), cells.end(), cell);
    if (found == cells.end() || *found != cell) return texel_radiance(pyramid, grid, at);
    const auto voxel = static_cast<std::size_t>(found - cells.begin());
    const bool back =
        !lit.back.empty() && glm::dot(lit.grid->backs[voxel].normal - lit.grid->points[voxel].normal, seen_normal) > 0.0f;
    return back ? lit.back[voxel] : lit.radiance[voxel];
}

const Pyramid& hierarchy_of(Pyramids pyramids, std::uint32_t body) {
    const Pyramid* found = pyramids.front();
    for (const Pyramid* pyramid : pyramids) {
        if (pyramid->pose.body == body) return *pyramid;
        if (pyramid->pose.body == 0) found = pyramid;
    }
    return *found;
}

}  // namespace

vec3 radiance_at_hit(Pyramids pyramids, const Scene& scene, const Hit& hit, const vec3& direction) {
    const HitGeometry at = hit_geometry(*scene.geometry, hit.instance, hit.triangle, hit.u, hit.v);
    const bool back = glm::dot(at.geometric_normal, direction) > 0.0f;
    if (back && !scene.materials[scene.material_of(hit.triangle)].two_sided) return vec3(0);
    const Pyramid& pyramid = hierarchy_of(pyramids, scene.geometry->instances[hit.instance].body);
    const Domain& domain = pyramid.domain;
    const auto [grid, point] = domain.place(domain.to_linear(pyramid.pose.to_body(at.position)));
    // Outside of a view volume nothing is known; outside of the scene's bounds is rounding.
    if (domain.warp.view_volume() && !domain.inside(point)) return vec3(0);
    ivec3 cell = glm::clamp(ivec3(glm::floor(point)), ivec3(0), domain.cells - 1);
    if (!nearest_occupied(pyramid, grid, point, cell)) return vec3(0);
    if (pyramid.lit == nullptr) return texel_radiance(pyramid, grid, cell);
    return side_radiance(pyramid, grid, cell, back ? -at.geometric_normal : at.geometric_normal);
}

}  // namespace interreflect
