#include "visibility/trace_gbuffer.h"

#include <array>
#include <stdexcept>
#include <string>

#include "data/environment.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16, packet_side = 4;
constexpr int packet_rays = packet_side * packet_side;

GBuffer allocate(const Camera& camera, int width, int height) {
    GBuffer g;
    g.width = width;
    g.height = height;
    g.camera = camera;
    const std::size_t n = g.pixels();
    g.position = Buffer<vec3>(n);
    g.geometric_normal = Buffer<vec3>(n);
    g.normal = Buffer<vec3>(n);
    g.albedo = Buffer<vec3>(n);
    g.specular = Buffer<vec3>(n);
    g.emission = Buffer<vec3>(n);
    g.alpha = Buffer<float>(n);
    g.depth = Buffer<float>(n);
    g.offset = Buffer<float>(n);
    g.triangle = Buffer<std::uint32_t>(n);
    g.instance = Buffer<std::uint32_t>(n);
    g.body = Buffer<std::uint32_t>(n);
    return g;
}

void store_miss(GBuffer& g, std::size_t pixel, const vec3& radiance) {
    g.position[pixel] = g.geometric_normal[pixel] = g.normal[pixel] = vec3(0);
    g.albedo[pixel] = g.specular[pixel] = vec3(0);
    g.emission[pixel] = radiance;
    g.alpha[pixel] = 1.0f;
    g.offset[pixel] = 0.0f;
    g.depth[pixel] = std::numeric_limits<float>::infinity();
    g.triangle[pixel] = g.instance[pixel] = no_hit;
    g.body[pixel] = 0;
}

void store_hit(GBuffer& g, std::size_t pixel, const Scene& scene, const Hit& hit, const CameraRays& rays, float x, float y) {
    const vec3 direction = rays.direction(x, y);
    const SurfacePoint point = surface_at(scene, hit, direction, pixel_footprint(scene, hit, rays, x, y));
    g.position[pixel] = point.position;
    g.geometric_normal[pixel] = point.geometric_normal;
    g.normal[pixel] = point.normal;
    g.albedo[pixel] = point.albedo;
    g.specular[pixel] = point.specular;
    g.emission[pixel] = point.emission;
    g.alpha[pixel] = point.alpha;
    g.depth[pixel] = hit.distance;
    g.offset[pixel] = point.offset;
    g.triangle[pixel] = hit.triangle;
    g.instance[pixel] = hit.instance;
    g.body[pixel] = scene.geometry->instances[hit.instance].body;
}

/// One tile: its rays in packets of 4 x 4 pixels, row by row; packets are cut at the picture's border.
void trace_tile(GBuffer& g, const Scene& scene, const Intersector& intersector, const CameraRays& rays, const Tile& tile) {
    std::array<Ray, tile_size * tile_size> queries;
    std::array<Hit, tile_size * tile_size> hits;
    std::array<std::array<int, 2>, tile_size * tile_size> pixels;
    std::size_t count = 0;
    for (int py = tile.y0; py < tile.y1; py += packet_side)
        for (int px = tile.x0; px < tile.x1; px += packet_side)
            for (int k = 0; k < packet_rays; ++k) {
                const int x = px + k % packet_side, y = py + k / packet_side;
                if (x >= tile.x1 || y >= tile.y1) continue;
                queries[count].origin = rays.origin;
                queries[count].direction = rays.direction(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                pixels[count++] = {x, y};
            }
    intersector.nearest_coherent({queries.data(), count}, {hits.data(), count});
    for (std::size_t i = 0; i < count; ++i) {
        const auto [x, y] = pixels[i];
        const std::size_t pixel = static_cast<std::size_t>(y) * g.width + x;
        if (hits[i].valid())
            store_hit(g, pixel, scene, hits[i], rays, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        else
            store_miss(g, pixel, environment_radiance(scene, queries[i].direction));
    }
}

}  // namespace

void check_view(const Camera& camera, int width, int height) {
    constexpr int most = 1 << 15;
    if (width < 1 || height < 1 || width > most || height > most)
        throw std::invalid_argument("width and height must lie in [1, " + std::to_string(most) + "], got " +
                                    std::to_string(width) + " x " + std::to_string(height));
    const CameraRays rays(camera, width, height);
    const vec3 sum = rays.origin + rays.corner + rays.right_step + rays.down_step;
    if (!std::isfinite(sum.x + sum.y + sum.z) || !(camera.fov_x > 0.0f && camera.fov_x < 180.0f))
        throw std::invalid_argument("camera: position, target and up must be finite and not in line, 0 < fov_x < 180 degrees");
}

Footprint pixel_footprint(const Scene& scene, const Hit& hit, const CameraRays& rays, float x, float y) {
    const auto& arrays = *scene.geometry->arrays;
    const Corners c = world_corners(*scene.geometry, hit.instance, hit.triangle);
    const vec3 e1 = c.b - c.a, e2 = c.c - c.a, normal = glm::cross(e1, e2);
    const vec3 direction = rays.unnormalised(x, y);
    // Ray differentials on the plane of the triangle [Igehy 1999]: the ray of the next pixel meets it at another distance.
    const float along = hit.distance / glm::length(direction), turn = 1.0f / glm::dot(direction, normal);
    const vec3 dx = (rays.right_step - direction * (glm::dot(rays.right_step, normal) * turn)) * along;
    const vec3 dy = (rays.down_step - direction * (glm::dot(rays.down_step, normal) * turn)) * along;
    const float scale = 1.0f / glm::dot(normal, normal);
    const vec3 gradient_u = glm::cross(e2, normal) * scale, gradient_v = glm::cross(normal, e1) * scale;
    const uvec3 t = arrays.triangles[hit.triangle];
    const vec2 uv1 = arrays.texcoords[t.y] - arrays.texcoords[t.x], uv2 = arrays.texcoords[t.z] - arrays.texcoords[t.x];
    return {uv1 * glm::dot(gradient_u, dx) + uv2 * glm::dot(gradient_v, dx),
            uv1 * glm::dot(gradient_u, dy) + uv2 * glm::dot(gradient_v, dy)};
}

GBuffer trace_gbuffer(const Scene& scene, const Intersector& intersector, const Camera& camera, int width, int height) {
    check_view(camera, width, height);
    GBuffer g = allocate(camera, width, height);
    const CameraRays rays(camera, width, height);
    parallel_tiles(width, height, tile_size, [&](const Tile& tile) { trace_tile(g, scene, intersector, rays, tile); });
    g.counts.rays = g.pixels();
    return g;
}

}  // namespace interreflect
