#include "surfels/place/point_on_surface.h"

#include <vector>

#include "math/sampling.h"

namespace interreflect {
namespace {

/// Whether a triangle's mask leaves anything there.
bool solid(const Scene& scene, std::uint32_t triangle, const vec2& b) {
    const int mask = scene.materials[scene.material_of(triangle)].mask;
    if (mask < 0) return true;
    const auto& arrays = *scene.geometry->arrays;
    const uvec3 t = arrays.triangles[triangle];
    return scene.masks[static_cast<std::size_t>(mask)]->solid(arrays.texcoords[t.x] * (1.0f - b.x - b.y) +
                                                              arrays.texcoords[t.y] * b.x + arrays.texcoords[t.z] * b.y);
}

struct Place {
    std::uint32_t triangle;
    vec2 barycentric;
};

double area_of(const Corners& c) { return 0.5 * static_cast<double>(glm::length(glm::cross(c.b - c.a, c.c - c.a))); }

}  // namespace

Surfels surfels_by_area(const Scene& scene, int count, const PointOfSquare& point) {
    const Geometry& geometry = *scene.geometry;
    const Group& still = geometry.groups.front();
    double total = 0;
    Bounds bounds;
    for (std::uint32_t t = 0; t < still.triangle_count; ++t) {
        const Corners c = world_corners(geometry, 0, still.first_triangle + t);
        total += area_of(c);
        bounds.add(c.a), bounds.add(c.b), bounds.add(c.c);
    }
    std::vector<Place> places;
    double before = 0;
    std::uint32_t number = 0;
    const double share = total > 0 ? count / total : 0;
    for (std::uint32_t t = 0; t < still.triangle_count; ++t) {
        const std::uint32_t triangle = still.first_triangle + t;
        before += area_of(world_corners(geometry, 0, triangle));
        // Surfel k stands in the middle of its k-th share of all area.
        for (; number < static_cast<std::uint32_t>(count) && number + 0.5 <= before * share; ++number) {
            const vec2 b = uniform_triangle(point(number));
            if (solid(scene, triangle, b)) places.push_back({triangle, b});
        }
    }
    Surfels surfels = make_surfels(places.size());
    surfels.extent = total > 0 ? glm::length(bounds.upper - bounds.lower) : 0.0f;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Corners c = world_corners(geometry, 0, places[i].triangle);
        const vec2 b = places[i].barycentric;
        surfels.position[i] = c.a + (c.b - c.a) * b.x + (c.c - c.a) * b.y;
        surfels.normal[i] = glm::normalize(glm::cross(c.b - c.a, c.c - c.a));
        surfels.area[i] = static_cast<float>(total / count);
        surfels.triangle[i] = places[i].triangle;
        surfels.barycentric[i] = b;
    }
    return surfels;
}

}  // namespace interreflect
