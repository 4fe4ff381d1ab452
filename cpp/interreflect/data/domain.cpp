#include "data/domain.h"

#include <cmath>

namespace interreflect {

VoxelPlace Domain::place(const vec3& p) const {
    if (cascades == 1) return {0, warp.to_voxels(p, cells)};
    for (int k = 0;; ++k) {
        const vec3 q = in_cascade(k, p);
        if (k + 1 == cascades || inside(q)) return {k, q};
    }
}

vec3 Domain::linear_of(const VoxelPlace& at) const {
    if (cascades == 1) return warp.to_linear(at.voxels, cells);
    return linear_in(at.cascade, at.voxels);
}

mat3 Domain::density(const vec3& p) const {
    if (cascades == 1) return warp.density(p, cells);
    return mat3(1.0f / static_cast<float>(1 << place(p).cascade));
}

float Domain::grid_level(const vec3& p) const {
    float level = 0;
    for (int k = 0; k + 1 < cascades; ++k) {
        const vec3 first = linear_in(k, vec3(0)), last = linear_in(k, vec3(cells)), depth = glm::min(p - first, last - p);
        const vec2 edge = band(k);
        level += glm::clamp(1.0f - (std::min({depth.x, depth.y, depth.z}) - edge.x) * edge.y, 0.0f, 1.0f);
    }
    return level;
}

float Domain::view_radius() const {
    const vec2 sides = warp.kind == Warp::Kind::perspective ? vec2(warp.half_x, warp.half_y) : vec2(0);
    return warp.far * std::sqrt(1.0f + glm::dot(sides, sides));
}

float Domain::longest_way() const {
    if (warp.view_volume()) {
        const float angle = 2.0f * std::min(warp.half_x / static_cast<float>(cells.x), warp.half_y / static_cast<float>(cells.y));
        return 2.0f * view_radius() / std::min(1.0f, angle * warp.near);
    }
    const float diagonal = glm::length(vec3(cells)) * static_cast<float>(1 << (cascades - 1));
    return warp.kind == Warp::Kind::linear ? diagonal : diagonal * std::max({1.0f, warp.steepness, 3.0f - 2.0f * warp.steepness});
}

}  // namespace interreflect
