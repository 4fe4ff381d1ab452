#include "voxels/march/gather.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {

GatheredLight merge_gathered(const Share& share, const GBuffer& gbuffer, std::span<const float> weights,
                             const Buffer<vec4>& voxels, float scale, const Buffer<vec4>& sky, const vec3& constant,
                             std::span<const Counts> counts) {
    GatheredLight light;
    light.width = gbuffer.width;
    light.height = gbuffer.height;
    light.irradiance = Buffer<vec3>(gbuffer.pixels());
    light.sky = Buffer<vec3>(gbuffer.pixels());
    light.occlusion = Buffer<float>(gbuffer.pixels());
    merge(share, gbuffer, weights, voxels, [&](std::size_t first, std::span<const vec4> values) {
        for (std::size_t k = 0; k < values.size(); ++k) {
            const std::size_t i = first + k;
            const vec4& v = values[k];
            const bool hit = gbuffer.hit(i);
            light.irradiance[i] = hit ? vec3(v) * scale : vec3(0);
            light.occlusion[i] = hit ? std::clamp(1.0f - v.w, 0.0f, 1.0f) : 0.0f;
            if (sky.empty()) light.sky[i] = hit ? constant * (v.w * pi) : vec3(0);
        }
    });
    if (!sky.empty())
        merge(share, gbuffer, weights, sky, [&](std::size_t first, std::span<const vec4> values) {
            for (std::size_t k = 0; k < values.size(); ++k)
                light.sky[first + k] = gbuffer.hit(first + k) ? vec3(values[k]) * pi : vec3(0);
        });
    for (const auto& one : counts) light.counts += one;
    return light;
}

GlossyLight finish_glossy(const GBuffer& gbuffer, const Buffer<vec4>& voxels, float scale, const Buffer<vec4>& sky,
                          std::span<const Counts> counts) {
    GlossyLight light;
    light.width = gbuffer.width;
    light.height = gbuffer.height;
    light.radiance = Buffer<vec3>(gbuffer.pixels());
    light.sky = Buffer<vec3>(gbuffer.pixels());
    parallel_blocks(gbuffer.pixels(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const bool hit = gbuffer.hit(i);
            light.radiance[i] = hit ? vec3(voxels[i]) * scale : vec3(0);
            light.sky[i] = hit ? vec3(sky[i]) : vec3(0);
        }
    });
    for (const auto& one : counts) light.counts += one;
    return light;
}

}  // namespace interreflect
