#include "virtual_lights/shadow/imperfect_shadow_maps.h"

#include <algorithm>
#include <stdexcept>

#include "math/parallel.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "shading/table.h"
#include "virtual_lights/shadow/point_maps.h"
#include "visibility/surface.h"

namespace interreflect {
namespace {

constexpr std::size_t most_texels = std::size_t{4096} * 4096;

/// A triangle as one instance places it.
struct Placed {
    std::uint32_t instance, triangle;
};

std::vector<Placed> placed_triangles(const Geometry& geometry) {
    std::vector<Placed> all;
    for (std::uint32_t i = 0; i < geometry.instances.size(); ++i) {
        const Group& group = geometry.groups[geometry.instances[i].group];
        for (std::uint32_t k = 0; k < group.triangle_count; ++k) all.push_back({i, group.first_triangle + k});
    }
    return all;
}

float area_of(const Corners& c) { return 0.5f * glm::length(glm::cross(c.b - c.a, c.c - c.a)); }

/// Whether a triangle's mask leaves anything there.
bool solid(const Scene& scene, std::uint32_t triangle, const vec2& barycentric) {
    const int mask = scene.materials[scene.material_of(triangle)].mask;
    if (mask < 0) return true;
    const auto& arrays = *scene.geometry->arrays;
    const uvec3 t = arrays.triangles[triangle];
    const vec2 b = barycentric;
    return scene.masks[static_cast<std::size_t>(mask)]->solid(arrays.texcoords[t.x] * (1.0f - b.x - b.y) +
                                                              arrays.texcoords[t.y] * b.x + arrays.texcoords[t.z] * b.y);
}

std::vector<WorldPoint> world_points(const SurfacePoints& points, const Geometry& geometry) {
    std::vector<WorldPoint> world(points.size());
    parallel_blocks(points.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Instance& placed = geometry.instances[points.instance[i]];
            world[i] = {placed.world_from_local * vec4(points.position[i], 1.0f),
                        glm::normalize(placed.normal_from_local * points.normal[i])};
        }
    });
    return world;
}

}  // namespace

SurfacePoints scatter_points(const ImperfectShadowMaps& technique, const Scene& scene) {
    const auto all = placed_triangles(*scene.geometry);
    std::vector<float> cdf(all.size() + 1, 0.0f);
    for (std::size_t i = 0; i < all.size(); ++i)
        cdf[i + 1] = area_of(world_corners(*scene.geometry, all[i].instance, all[i].triangle));
    const double area = make_cdf(cdf);
    const std::size_t n = area > 0 ? static_cast<std::size_t>(technique.points) : 0;
    SurfacePoints points{Buffer<vec3>(n), Buffer<vec3>(n), Buffer<std::uint32_t>(n), static_cast<float>(area),
                         scene.geometry->instances.size()};
    const auto& arrays = *scene.geometry->arrays;
    parallel_blocks(n, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            // Random, not a regular sequence: every n-th point must be spread as evenly as all, for any number n of lights.
            Rng random(0x9e1u, static_cast<std::uint32_t>(i));
            constexpr int tries = 16;  // to find a place that a mask leaves solid
            Placed placed{};
            vec2 b{0};
            for (int k = 0; k < tries; ++k) {
                placed = all[choose_entry(cdf, random.uniform()).index];
                const float u = random.uniform();
                b = uniform_triangle({u, random.uniform()});
                if (solid(scene, placed.triangle, b)) break;
            }
            const uvec3 t = arrays.triangles[placed.triangle];
            const vec3 a = arrays.positions[t.x], e1 = arrays.positions[t.y] - a, e2 = arrays.positions[t.z] - a;
            points.position[i] = a + e1 * b.x + e2 * b.y;
            points.normal[i] = glm::normalize(glm::cross(e1, e2));
            points.instance[i] = placed.instance;
        }
    });
    return points;
}

LightShadows shadow_lights(const ImperfectShadowMaps& technique, const VirtualLights& lights, const SurfacePoints& points,
                           const Scene& scene) {
    const std::size_t n = lights.size(), texels = static_cast<std::size_t>(technique.size) * technique.size;
    if (n * texels > most_texels)
        throw std::invalid_argument("ImperfectShadowMaps: " + std::to_string(n) + " lights' maps of " +
                                    std::to_string(technique.size) + "^2 texels are more than 4096^2 together");
    if (points.size() > 0 && points.instances != scene.geometry->instances.size())
        throw std::invalid_argument("ImperfectShadowMaps: the points are of a scene with " + std::to_string(points.instances) +
                                    " instances, this one has " + std::to_string(scene.geometry->instances.size()));
    LightShadows shadows;
    shadows.kind = LightShadows::Kind::maps;
    shadows.size = technique.size;
    shadows.depth = Buffer<float>(n * texels);
    if (n == 0) return shadows;
    const auto world = world_points(points, *scene.geometry);
    const auto directions = paraboloid_directions(technique.size);
    // A map's points stand for the whole surface.
    const float each = points.area * static_cast<float>(n) / static_cast<float>(std::max<std::size_t>(points.size(), 1));
    const float radius = std::sqrt(each / pi) * static_cast<float>(technique.point_size);
    shadows.bias = static_cast<float>(technique.bias) * 2.0f * radius;
    std::vector<Filled> filled(n);
    parallel_pieces(n, [&](std::size_t light) {
        const auto depth = shadows.depth.span().subspan(light * texels, texels);
        PointMap map(depth, directions, technique.size, lights.position[light], lights.normal[light]);
        for (std::size_t i = light; i < world.size(); i += n)
            if (technique.splat == "disk")
                map.draw_disk(world[i], radius);
            else
                map.draw_square(world[i], radius);
        filled[light] = pull_push(depth, technique.size, technique.iterations, directions);
    });
    shadows.counts.surface_points = world.size();
    for (const Filled& one : filled) shadows.counts.empty_texels += one.empty, shadows.counts.filled_texels += one.filled;
    return shadows;
}

}  // namespace interreflect
