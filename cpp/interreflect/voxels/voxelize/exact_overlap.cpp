#include "voxels/voxelize/exact_overlap.h"

#include <algorithm>
#include <array>

#include "math/sampling.h"
#include "voxels/voxelize/contributions.h"
#include "voxels/voxelize/polygon.h"

namespace interreflect {
namespace {

/// Whether an axis separates a triangle (relative to the cell's centre) from the unit cell.
bool separates(const vec3& axis, const std::array<vec3, 3>& p) {
    const float a = glm::dot(axis, p[0]), b = glm::dot(axis, p[1]), c = glm::dot(axis, p[2]);
    const float radius = 0.5f * (std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z));
    return std::min({a, b, c}) > radius || std::max({a, b, c}) < -radius;
}

/// The thirteen axes of a triangle and a box [Akenine-Moeller 2001].
bool overlaps(const std::array<vec3, 3>& p, const vec3& normal) {
    constexpr std::array<vec3, 3> axes{vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}};
    for (const vec3& axis : axes)
        if (separates(axis, p)) return false;
    if (separates(normal, p)) return false;
    for (int edge = 0; edge < 3; ++edge)
        for (const vec3& axis : axes)
            if (separates(glm::cross(axis, p[(edge + 1) % 3] - p[edge]), p)) return false;
    return true;
}

/// The triangle's part in the half-open cell [-0.5, 0.5)^3; empty where it only touches the upper faces.
Polygon clip(const std::array<vec3, 3>& p) {
    Polygon polygon;
    polygon.count = 3;
    std::copy(p.begin(), p.end(), polygon.corner.begin());
    for (int axis = 0; axis < 3 && polygon.count > 0; ++axis) {
        polygon = between(polygon, axis, -0.5f, 0.5f);
        bool on_upper_face = true;
        for (int i = 0; i < polygon.count; ++i) on_upper_face &= polygon.corner[i][axis] >= 0.5f;
        if (on_upper_face) polygon.count = 0;
    }
    return polygon;
}

float area_of(const Polygon& polygon) {
    vec3 sum{0};
    for (int i = 1; i + 1 < polygon.count; ++i)
        sum += glm::cross(polygon.corner[i] - polygon.corner[0], polygon.corner[i + 1] - polygon.corner[0]);
    return 0.5f * glm::length(sum);
}

/// Barycentric coordinates of the second and third corner.
vec2 barycentric(const std::array<vec3, 3>& p, const vec3& at) {
    const vec3 e1 = p[1] - p[0], e2 = p[2] - p[0], d = at - p[0], n = glm::cross(e1, e2);
    const float scale = 1.0f / glm::dot(n, n);
    return {glm::dot(glm::cross(d, e2), n) * scale, glm::dot(glm::cross(e1, d), n) * scale};
}

/// Adds the part of a triangle in one cell: by its centroid where the surface is uniform, else by points spread over it.
void add_part(const VoxelTriangle& t, const std::array<vec3, 3>& local, const Polygon& part, const ivec3& cell, int samples,
              ContributionSink& sink) {
    const bool uniform = t.uniform();
    const float whole = area_of(part);
    const float footprint = std::min(t.area, 1.0f / static_cast<float>(samples));
    for (int i = 1; i + 1 < part.count; ++i) {
        const vec3 a = part.corner[0], b = part.corner[i], c = part.corner[i + 1];
        const float area = 0.5f * glm::length(glm::cross(b - a, c - a));
        if (!(area > 1e-5f * whole)) continue;  // corners in a row: a strip that is there by rounding
        if (uniform) {
            sink.add(cell, (a + b + c) / 3.0f, area, true, t.material->albedo, t.material->emission);
            continue;
        }
        const int count = std::clamp(static_cast<int>(std::ceil(area * static_cast<float>(samples))), 1, samples);
        const float each = area / static_cast<float>(count);
        for (int k = 0; k < count; ++k) {
            // The R2 sequence [Roberts 2018]: low discrepancy, no seed.
            const float r = static_cast<float>(k) + 0.5f;
            const vec2 u{glm::fract(r * 0.7548776662f), glm::fract(r * 0.5698402910f)};
            const vec2 at = uniform_triangle(u);
            const vec3 position = a * (1.0f - at.x - at.y) + b * at.x + c * at.y;
            const vec2 weights = barycentric(local, position);
            const vec2 uv =
                t.texcoord[0] * (1.0f - weights.x - weights.y) + t.texcoord[1] * weights.x + t.texcoord[2] * weights.y;
            const bool solid = t.mask == nullptr || t.mask->solid(uv);
            vec3 albedo = t.material->albedo, emission = t.material->emission;
            if (t.albedo_map != nullptr) albedo *= t.albedo_map->bilinear(uv, t.level(*t.albedo_map, footprint));
            if (t.emission_map != nullptr) emission *= t.emission_map->bilinear(uv, t.level(*t.emission_map, footprint));
            sink.add(cell, position, each, solid, albedo, emission);
        }
    }
}

void overlap_triangle(const VoxelTriangle& t, const ivec3& cells, int samples, ContributionSink& sink) {
    const vec3 lower = glm::min(glm::min(t.corner[0], t.corner[1]), t.corner[2]);
    const vec3 upper = glm::max(glm::max(t.corner[0], t.corner[1]), t.corner[2]);
    const ivec3 first(glm::floor(glm::clamp(lower, vec3(0), vec3(cells - 1))));
    const ivec3 last(glm::floor(glm::clamp(upper, vec3(0), vec3(cells - 1))));
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                const vec3 centre = vec3(ivec3(x, y, z)) + 0.5f;
                const std::array<vec3, 3> local{t.corner[0] - centre, t.corner[1] - centre, t.corner[2] - centre};
                if (!overlaps(local, t.normal)) continue;
                const Polygon part = clip(local);
                // Coordinates of a thousand voxels are known to 1e-4: a thinner strip of a triangle is a touch by rounding.
                if (area_of(part) > 1e-4f * std::min(t.area, 1.0f)) add_part(t, local, part, {x, y, z}, samples, sink);
            }
}

}  // namespace

VoxelGrid voxelize(const ExactOverlap& technique, const Scene& scene, const Domain& domain) {
    return voxelize_triangles(scene, domain, Handing::pieces, [&](const VoxelTriangle& triangle, ContributionSink& sink) {
        overlap_triangle(triangle, domain.cells, technique.samples, sink);
    });
}

}  // namespace interreflect
