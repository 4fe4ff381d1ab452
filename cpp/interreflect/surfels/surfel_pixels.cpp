#include "surfels/surfel_pixels.h"

#include <algorithm>
#include <cmath>

#include "math/parallel.h"
#include "visibility/surface.h"

namespace interreflect {
namespace {

constexpr std::size_t row = 256;  // pixels

/// How texture coordinates change over a square of a surfel's area.
Footprint footprint_of(const Surfels& surfels, std::size_t i, const Scene& scene) {
    const auto& arrays = *scene.geometry->arrays;
    const Corners c = world_corners(*scene.geometry, 0, surfels.triangle[i]);
    const vec3 e1 = c.b - c.a, e2 = c.c - c.a, normal = glm::cross(e1, e2);
    const float scale = 1.0f / glm::dot(normal, normal);
    const vec3 gradient_u = glm::cross(e2, normal) * scale, gradient_v = glm::cross(normal, e1) * scale;
    const uvec3 t = arrays.triangles[surfels.triangle[i]];
    const vec2 uv1 = arrays.texcoords[t.y] - arrays.texcoords[t.x], uv2 = arrays.texcoords[t.z] - arrays.texcoords[t.x];
    const float side = std::sqrt(surfels.area[i]);
    const vec3 x = glm::normalize(e1) * side, y = glm::cross(surfels.normal[i], x);
    return {uv1 * glm::dot(gradient_u, x) + uv2 * glm::dot(gradient_v, x),
            uv1 * glm::dot(gradient_u, y) + uv2 * glm::dot(gradient_v, y)};
}

}  // namespace

GBuffer surfel_pixels(const Surfels& surfels, const Scene& scene) {
    const std::size_t n = surfels.size(), rows = std::max<std::size_t>((n + row - 1) / row, 1), all = rows * row;
    GBuffer g;
    g.width = static_cast<int>(row), g.height = static_cast<int>(rows);
    g.seen_head_on = true;
    g.position = Buffer<vec3>(all, vec3(0)), g.geometric_normal = Buffer<vec3>(all, vec3(0)),
    g.normal = Buffer<vec3>(all, vec3(0));
    g.albedo = Buffer<vec3>(all, vec3(0)), g.specular = Buffer<vec3>(all, vec3(0)), g.emission = Buffer<vec3>(all, vec3(0));
    g.alpha = Buffer<float>(all, 1.0f), g.depth = Buffer<float>(all, std::numeric_limits<float>::infinity());
    g.offset = Buffer<float>(all, 0.0f);
    g.triangle = Buffer<std::uint32_t>(all, no_hit), g.instance = Buffer<std::uint32_t>(all, no_hit);
    g.body = Buffer<std::uint32_t>(all, 0U);
    parallel_blocks(n, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Hit hit{1.0f, 0, surfels.triangle[i], surfels.barycentric[i].x, surfels.barycentric[i].y};
            const SurfacePoint point = surface_at(scene, hit, -surfels.normal[i], footprint_of(surfels, i, scene));
            g.position[i] = surfels.position[i];
            g.geometric_normal[i] = g.normal[i] = surfels.normal[i];
            g.albedo[i] = point.albedo, g.emission[i] = point.emission;
            g.depth[i] = 1.0f, g.offset[i] = point.offset;
            g.triangle[i] = surfels.triangle[i], g.instance[i] = 0;
        }
    });
    return g;
}

}  // namespace interreflect
