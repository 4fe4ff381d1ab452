#include "caches/interpolate/finish.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {

CacheLight empty_cache_light(const GBuffer& gbuffer) {
    const std::size_t pixels = gbuffer.pixels();
    CacheLight light;
    light.gathered = {gbuffer.width, gbuffer.height, Buffer<vec3>(pixels), Buffer<vec3>(pixels), Buffer<float>(pixels), {}};
    light.glossy = {gbuffer.width, gbuffer.height, Buffer<vec3>(pixels), Buffer<vec3>(pixels), {}};
    light.weight = Buffer<float>(pixels);
    parallel_blocks(pixels, 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            light.gathered.irradiance[i] = light.gathered.sky[i] = light.glossy.radiance[i] = light.glossy.sky[i] = vec3(0);
            light.gathered.occlusion[i] = light.weight[i] = 0.0f;
        }
    });
    return light;
}

void finish_pixel(const ConvolvedCaches& caches, const PixelViews::View& view, const CacheSum& sum, CacheLight& light) {
    const FilledCaches& filled = *caches.filled;
    const float mean = 1.0f / sum.weight, unit = mean * filled.scale;
    const bool image = !filled.sky.empty();
    const std::uint32_t i = view.pixel;
    light.weight[i] = sum.weight;
    light.gathered.irradiance[i] = vec3(sum.diffuse) * (pi * unit);
    light.gathered.occlusion[i] = std::clamp(1.0f - sum.diffuse.w * mean, 0.0f, 1.0f);
    light.gathered.sky[i] = image ? sum.diffuse_sky * (pi * unit) : filled.sky_radiance * (pi * sum.diffuse.w * mean);
    if (!view.glossy) return;
    light.glossy.radiance[i] = vec3(sum.glossy) * view.albedo * unit;
    light.glossy.sky[i] = view.albedo * (image ? sum.glossy_sky * unit : filled.sky_radiance * (sum.glossy.w * mean));
}

}  // namespace interreflect
