#include "visibility/trace_gbuffer.h"

#include <stdexcept>
#include <string>

#include "data/environment.h"
#include "math/parallel.h"
#include "visibility/gbuffer_kernel.h"

namespace interreflect {
namespace {

constexpr int tile_size = 32;

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

void store_gbuffer_pixel(const GBufferJob& job, int x, int y, const Hit& hit) {
    const std::size_t pixel = static_cast<std::size_t>(y) * job.g.width + x;
    const float cx = static_cast<float>(x) + 0.5f, cy = static_cast<float>(y) + 0.5f;
    if (hit.valid())
        store_hit(job.g, pixel, job.scene, hit, job.rays, cx, cy);
    else
        store_miss(job.g, pixel, environment_radiance(job.scene, job.rays.direction(cx, cy)));
}

GBuffer trace_gbuffer(const Scene& scene, const Intersector& intersector, const Camera& camera, int width, int height) {
    check_view(camera, width, height);
    GBuffer g = allocate(camera, width, height);
    const CameraRays rays(camera, width, height);
    const float pixel_area = glm::length(rays.right_step) * glm::length(rays.down_step);
    const GBufferJob job{scene, intersector, rays, g, pixel_area, kernel_materials(scene)};
    parallel_tiles(width, height, tile_size, [&](const Tile& tile) { trace_gbuffer_tile(job, tile); });
    g.counts.rays = g.pixels();
    return g;
}

}  // namespace interreflect
