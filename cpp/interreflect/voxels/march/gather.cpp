#include "voxels/march/gather.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {

GatheredLight finish_gathering(const GBuffer& gbuffer, const Buffer<vec4>& voxels, float scale, const Buffer<vec4>& sky,
                               const vec3& constant, std::span<const Counts> counts) {
    GatheredLight light;
    light.width = gbuffer.width;
    light.height = gbuffer.height;
    light.irradiance = Buffer<vec3>(gbuffer.pixels());
    light.sky = Buffer<vec3>(gbuffer.pixels());
    light.occlusion = Buffer<float>(gbuffer.pixels());
    parallel_blocks(gbuffer.pixels(), 16384, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const bool hit = gbuffer.hit(i);
            const vec4& v = voxels[i];
            light.irradiance[i] = hit ? vec3(v) * scale : vec3(0);
            light.sky[i] = !hit ? vec3(0) : sky.empty() ? constant * (v.w * pi) : vec3(sky[i]) * pi;
            light.occlusion[i] = hit ? std::clamp(1.0f - v.w, 0.0f, 1.0f) : 0.0f;
        }
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
