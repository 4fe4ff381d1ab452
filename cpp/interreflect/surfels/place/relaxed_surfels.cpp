#include "surfels/place/relaxed_surfels.h"

#include <algorithm>
#include <cmath>

#include "math/parallel.h"
#include "surfels/place/halton_surfels.h"
#include "surfels/place/surfel_grid.h"

namespace interreflect {
namespace {

// In roots of a surfel's area. The densest packing of equal disks lies 1.075 apart. On a square, and on Sponza at 32k: neighbours
// from further away leave the spacing less even; twice the strength is as good on the square, but overshoots at edges.
constexpr float reach = 1.25f, strength = 0.5f, shortest = 1e-3f;

struct Place {
    vec3 position, normal;
    std::uint32_t triangle;
    vec2 barycentric;
};

/// Where all that lie within reach push surfel i together, along its plane.
vec3 push(const Surfels& s, const SurfelGrid& grid, std::size_t i, float radius) {
    vec3 sum(0);
    grid.for_each_near(s.position[i], [&](std::uint32_t j) {
        const vec3 away = s.position[i] - s.position[j];
        const float distance = glm::length(away);
        if (j == i || distance >= radius || !(distance > 0.0f) || !same_side(s.normal[i], s.normal[j])) return;
        const float w = 1.0f - distance / radius;
        sum += away * (w * w / distance);
    });
    return sum - s.normal[i] * glm::dot(s.normal[i], sum);
}

/// Where a place comes to by a step along its plane: the surface nearest above or below. It stays where that turns by more than
/// 30 degrees, or lies further off than its turn explains: another sheet. slack: rounding, scene units.
Place stepped(const Place& from, const vec3& step, float slack, const Scene& scene, const Intersector& intersector) {
    constexpr float least_cosine = 0.866f, steepest = 0.577f;
    constexpr int layers = 8;
    const float length = glm::length(step), height = steepest * length + slack;
    float nearest = height;
    Place found = from;
    Ray ray{from.position + step + from.normal * height, 0.0f, -from.normal, 2.0f * height};
    for (int layer = 0; layer < layers; ++layer) {
        const Hit hit = intersector.nearest(ray);
        if (!hit.valid()) break;
        ray.near = std::nextafter(hit.distance, ray.far);
        const float off = std::abs(hit.distance - height);
        if (hit.instance != 0 || off > nearest) continue;
        const Corners c = world_corners(*scene.geometry, 0, hit.triangle);
        const vec3 normal = glm::normalize(glm::cross(c.b - c.a, c.c - c.a));
        const float cosine = glm::dot(normal, from.normal);
        if (!(cosine >= least_cosine)) continue;
        const float slope = std::sqrt(std::max(1.0f - cosine * cosine, 0.0f)) / cosine;
        if (off > (slope + 0.02f) * length + slack) continue;
        nearest = off;
        ray.far = height + off;
        found = {c.a + (c.b - c.a) * hit.u + (c.c - c.a) * hit.v, normal, hit.triangle, {hit.u, hit.v}};
    }
    return found;
}

}  // namespace

Surfels place_surfels(const RelaxedSurfels& technique, const Scene& scene, const Intersector& intersector) {
    Surfels surfels = place_surfels(HaltonSurfels{technique.surfels}, scene, intersector);
    if (surfels.size() == 0) return surfels;
    const float unit = std::sqrt(surfels.area[0]), radius = reach * unit, slack = 2e-7f * surfels.extent;
    Buffer<Place> places(surfels.size());
    const auto all = [&](const auto& body) {
        parallel_blocks(surfels.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) body(i);
        });
    };
    for (int iteration = 0; iteration < technique.iterations; ++iteration) {
        const SurfelGrid grid(surfels.position.span(), radius);
        all([&](std::size_t i) {
            places[i] = {surfels.position[i], surfels.normal[i], surfels.triangle[i], surfels.barycentric[i]};
            const vec3 step = push(surfels, grid, i, radius) * (strength * unit);
            if (glm::length(step) > shortest * unit) places[i] = stepped(places[i], step, slack, scene, intersector);
        });
        all([&](std::size_t i) {
            surfels.position[i] = places[i].position, surfels.normal[i] = places[i].normal;
            surfels.triangle[i] = places[i].triangle, surfels.barycentric[i] = places[i].barycentric;
        });
    }
    return surfels;
}

}  // namespace interreflect
