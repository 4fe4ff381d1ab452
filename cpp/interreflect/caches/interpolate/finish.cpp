#include "caches/interpolate/finish.h"

#include <algorithm>

namespace interreflect {

CacheLight empty_cache_light(const GBuffer& gbuffer) {
    const std::size_t pixels = gbuffer.pixels();
    CacheLight light;
    light.gathered = {gbuffer.width, gbuffer.height, Buffer<vec3>(pixels), Buffer<vec3>(pixels), Buffer<float>(pixels), {}};
    light.glossy = {gbuffer.width, gbuffer.height, Buffer<vec3>(pixels), Buffer<vec3>(pixels), {}};
    light.weight = Buffer<float>(pixels);
    return light;
}

void clear_unseen(const Tile& tile, int seeing, CacheLight& light) {
    if (seeing == (tile.x1 - tile.x0) * (tile.y1 - tile.y0)) return;
    const auto row = static_cast<std::size_t>(tile.x1 - tile.x0);
    for (int y = tile.y0; y < tile.y1; ++y) {
        const std::size_t i = static_cast<std::size_t>(y) * light.gathered.width + tile.x0;
        for (auto* vectors : {&light.gathered.irradiance, &light.gathered.sky, &light.glossy.radiance, &light.glossy.sky})
            std::fill_n(vectors->data() + i, row, vec3(0));
        std::fill_n(light.gathered.occlusion.data() + i, row, 0.0f);
        std::fill_n(light.weight.data() + i, row, 0.0f);
    }
}

void finish_pixel(const ConvolvedCaches& caches, const PixelViews::View& view, const CacheSum& sum, CacheLight& light) {
    const FilledCaches& filled = *caches.filled;
    const float mean = 1.0f / sum.weight, unit = mean * filled.scale, sky_unit = mean * filled.sky_scale;
    const bool image = !filled.sky.empty();
    const std::uint32_t i = view.pixel;
    light.weight[i] = sum.weight;
    light.gathered.irradiance[i] = vec3(sum.diffuse) * (pi * unit);
    light.gathered.occlusion[i] = std::clamp(1.0f - sum.diffuse.w * mean, 0.0f, 1.0f);
    light.gathered.sky[i] = image ? sum.diffuse_sky * (pi * sky_unit) : filled.sky_radiance * (pi * sum.diffuse.w * mean);
    if (!view.glossy) return;
    light.glossy.radiance[i] = vec3(sum.glossy) * view.albedo * unit;
    light.glossy.sky[i] = view.albedo * (image ? sum.glossy_sky * sky_unit : filled.sky_radiance * (sum.glossy.w * mean));
}

}  // namespace interreflect
