#include "voxels/march/voxel_lookup.h"

#include <glm/gtc/packing.hpp>
#include <limits>

namespace interreflect {
namespace {

vec4 finest_texel(const Pyramid& pyramid, const ivec3& at) {
    const auto& level = pyramid.levels.front();
    const std::uint16_t* texel = level.texels.data() + 4 * level.index(at.x, at.y, at.z);
    return {glm::unpackHalf1x16(texel[0]), glm::unpackHalf1x16(texel[1]), glm::unpackHalf1x16(texel[2]),
            glm::unpackHalf1x16(texel[3])};
}

/// The occupied texel among the 26 around `cell` whose centre is nearest to `point` (voxels); alpha 0 where there is none.
vec4 nearest_neighbour(const Pyramid& pyramid, const ivec3& cell, const vec3& point) {
    vec4 found(0);
    float least = std::numeric_limits<float>::infinity();
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const ivec3 at = cell + ivec3(x, y, z);
                if (glm::any(glm::lessThan(at, ivec3(0))) || glm::any(glm::greaterThanEqual(at, pyramid.domain.cells))) continue;
                const vec3 away = vec3(at) + 0.5f - point;
                const float distance = glm::dot(away, away);
                if (distance >= least) continue;
                const vec4 texel = finest_texel(pyramid, at);
                if (texel.w <= 0.0f) continue;
                found = texel;
                least = distance;
            }
    return found;
}

}  // namespace

vec3 radiance_at_hit(const Pyramid& pyramid, const Scene& scene, const Hit& hit, const vec3& direction) {
    const HitGeometry at = hit_geometry(*scene.geometry, hit.instance, hit.triangle, hit.u, hit.v);
    const bool back = glm::dot(at.geometric_normal, direction) > 0.0f;
    if (back && !scene.materials[scene.material_of(hit.triangle)].two_sided) return vec3(0);
    const vec3 point = pyramid.domain.to_voxels(at.position);
    const ivec3 cell = glm::clamp(ivec3(glm::floor(point)), ivec3(0), pyramid.domain.cells - 1);
    vec4 texel = finest_texel(pyramid, cell);
    if (texel.w <= 0.0f) texel = nearest_neighbour(pyramid, cell, point);
    return texel.w > 0.0f ? vec3(texel) * (pyramid.scale / texel.w) : vec3(0);
}

}  // namespace interreflect
