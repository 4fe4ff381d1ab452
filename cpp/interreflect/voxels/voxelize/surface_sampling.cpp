#include "voxels/voxelize/surface_sampling.h"

#include <algorithm>

#include "voxels/voxelize/appearance.h"

namespace interreflect {
namespace {

/// The part of start + along * u, u in [0, 1], that may lie in a box of `cells`.
vec2 part_inside(const vec3& start, const vec3& along, const vec3& cells) {
    float enter = 0.0f, leave = 1.0f;
    for (int axis = 0; axis < 3; ++axis) {
        if (along[axis] == 0.0f) continue;
        const float a = -start[axis] / along[axis], b = (cells[axis] - start[axis]) / along[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return {enter, leave};
}

/// Rows along the longest edge, each cut into equal pieces with a sample in their middle: every sample's area is known exactly,
/// and a sliver takes no more samples than its length asks for.
void sample_triangle(const VoxelTriangle& t, const vec3& cells, float spacing, ContributionSink& sink) {
    int base = 0;
    float longest = -1.0f;
    for (int i = 0; i < 3; ++i) {
        const vec3 edge = t.corner[(i + 1) % 3] - t.corner[i];
        const float length = glm::dot(edge, edge);
        if (length > longest) longest = length, base = i;
    }
    longest = std::sqrt(longest);
    const vec3 p0 = t.corner[base], p1 = t.corner[(base + 1) % 3], p2 = t.corner[(base + 2) % 3];
    const vec2 t0 = t.texcoord[base], t1 = t.texcoord[(base + 1) % 3], t2 = t.texcoord[(base + 2) % 3];
    const float height = 2.0f * t.area / longest;
    refuse_longer_than_most_voxels(longest);
    const int rows = std::max(1, static_cast<int>(std::ceil(height / spacing)));
    const bool uniform = t.uniform();
    const Appearance look(t, std::min(t.area, spacing * spacing));
    if (rows == 1 && 0.5f * longest <= spacing) {
        const vec2 uv = (t0 + t1) * 0.25f + t2 * 0.5f;
        const bool solid = look.solid(uv);
        sink.add_only((p0 + p1) * 0.25f + p2 * 0.5f, solid, uniform ? t.material->albedo : look.albedo(uv),
                      uniform ? t.material->emission : look.emission(uv));
        return;
    }
    for (int row = 0; row < rows; ++row) {
        const float v = (static_cast<float>(row) + 0.5f) / static_cast<float>(rows), rest = 1.0f - v;
        const int count = std::max(1, static_cast<int>(std::ceil(longest * rest / spacing)));
        const float area = 2.0f * t.area * rest / (static_cast<float>(rows) * static_cast<float>(count));
        const vec3 start = p0 * rest + p2 * v, along = (p1 - p0) * rest;
        const vec2 uv_start = t0 * rest + t2 * v, uv_along = (t1 - t0) * rest;
        int first = 0, last = count - 1;
        if (t.crosses) {  // one sample more at each end: rounding
            const vec2 inside = part_inside(start, along, cells) * static_cast<float>(count);
            if (!(inside.x <= inside.y)) continue;
            first = std::max(first, static_cast<int>(inside.x) - 1);
            last = std::min(last, static_cast<int>(inside.y) + 1);
        }
        for (int i = first; i <= last; ++i) {
            const float u = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
            const vec3 position = start + along * u;
            if (uniform) {
                sink.add(position, area, true, t.material->albedo, t.material->emission);
                continue;
            }
            const vec2 uv = uv_start + uv_along * u;
            const bool solid = look.solid(uv);
            sink.add(position, area, solid, look.albedo(uv), look.emission(uv));
        }
    }
}

}  // namespace

VoxelGrid voxelize(const SurfaceSampling& technique, const Scene& scene, const Domain& domain) {
    const auto spacing = static_cast<float>(technique.spacing);
    return voxelize_triangles(scene, domain, Handing::sampled,
                              [spacing, cells = vec3(domain.cells)](const VoxelTriangle& triangle, ContributionSink& sink) {
                                  sample_triangle(triangle, cells, spacing, sink);
                              });
}

}  // namespace interreflect
