#include "light_volumes/look_up.h"

#include "light_volumes/between.h"
#include "math/parallel.h"
#include "math/spherical_harmonics.h"

namespace interreflect {
namespace {

constexpr int tile_size = 16;     // pixels
constexpr float distance = 0.5f;  // cells, from where light comes to the surface

/// W/sr along a direction, at a point in cells.
vec3 intensity(const LightVolume& volume, const vec3& at, const vec3& direction) {
    float y[LightVolume::harmonics];
    spherical_harmonics(direction, 2, [&](int k, float value) { y[k] = value; });
    vec3 sum(0);
    Between(at - 0.5f, volume.domain.cells).each([&](const ivec3& cell, float share) {
        const float* c = volume.cell(volume.domain.cell(cell));
        for (int colour = 0; colour < 3; ++colour, c += LightVolume::harmonics)
            sum[colour] += share * (c[0] * y[0] + c[1] * y[1] + c[2] * y[2] + c[3] * y[3]);
    });
    return glm::max(sum, vec3(0));
}

}  // namespace

GatheredLight look_up(const LightVolume& volume, const GBuffer& gbuffer) {
    GatheredLight light;
    light.width = gbuffer.width, light.height = gbuffer.height;
    light.irradiance = Buffer<vec3>(gbuffer.pixels());
    const float width = volume.domain.voxel_size * distance, scale = 1.0f / (width * width);
    const vec3 cells(volume.domain.cells);
    parallel_tiles(gbuffer.width, gbuffer.height, tile_size, [&](const Tile& tile) {
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width) + x;
                light.irradiance[pixel] = vec3(0);
                if (!gbuffer.hit(pixel)) continue;
                const vec3 at = volume.domain.to_linear(gbuffer.position[pixel]);
                if (min_component(at) < 0.0f || min_component(cells - at) < 0.0f) continue;
                light.irradiance[pixel] = intensity(volume, at, -gbuffer.normal[pixel]) * scale;
            }
    });
    return light;
}

}  // namespace interreflect
