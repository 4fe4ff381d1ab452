#include "caches/interpolate/pixel_views.h"

#include <algorithm>
#include <cmath>

#include "math/hemisphere_map.h"
#include "shading/pixel_lobe.h"

namespace interreflect {

float one_percent_cosine(Lobe lobe, float alpha, float exponent) {
    constexpr float share = 0.01f;
    if (lobe == Lobe::phong) return exponent > 0.0f ? std::pow(share, 1.0f / exponent) : 0.0f;
    float sine2 = 1.0f;  // of the half vector's angle
    if (has_microfacets(lobe)) {
        // D / D(0) = a^4 / (cos^2 (a^2 - 1) + 1)^2 = .01 where sin^2 = 9 a^2 / (1 - a^2).
        const float a2 = alpha * alpha;
        if (a2 < 1.0f) sine2 = std::min((1.0f / std::sqrt(share) - 1.0f) * a2 / (1.0f - a2), 1.0f);
    } else if (exponent > 0.0f) {
        sine2 = 1.0f - std::pow(share, 2.0f / exponent);
    }
    return std::max(1.0f - 2.0f * sine2, 0.0f);
}

PixelViewer::PixelViewer(const GBuffer& gbuffer, const Scene& scene, const ConvolvedCaches& caches)
    : gbuffer_(gbuffer), scene_(scene), caches_(caches), tables_(gbuffer, scene) {}

float PixelViewer::level_of(std::size_t pixel, float half_angle) const {
    float cosine = std::cos(half_angle);
    if (caches_.width == LobeWidth::one_percent) {
        const PixelLobe lobe = lobe_at(gbuffer_, scene_.materials[scene_.material_of(gbuffer_.triangle[pixel])], pixel);
        cosine = one_percent_cosine(lobe.lobe, gbuffer_.alpha[pixel], lobe.exponent);
    }
    const float solid_angle = 2.0f * pi * std::max(1.0f - cosine, 1e-8f);
    const float level = 0.5f * std::log2(solid_angle / map_texel_solid_angle(caches_.filled->resolution)) + caches_.level_bias;
    return std::clamp(level, 0.0f, static_cast<float>(caches_.levels() - 1));
}

void PixelViewer::look(std::span<const std::uint32_t> pixels, PixelViews& views) const {
    thread_local Reflections lobes;
    std::array<std::uint16_t, PixelViews::capacity> of;  // lobe -> view
    lobes.count = 0;
    views.count = static_cast<int>(pixels.size());
    for (int i = 0; i < views.count; ++i) {
        const std::uint32_t pixel = pixels[static_cast<std::size_t>(i)];
        PixelViews::View& view = views.view[i];
        view.pixel = pixel;
        view.position = gbuffer_.position[pixel], view.normal = gbuffer_.normal[pixel];
        view.screen = vec2(static_cast<float>(pixel % gbuffer_.width), static_cast<float>(pixel / gbuffer_.width)) + 0.5f;
        view.glossy = max_component(gbuffer_.specular[pixel]) > 0.0f;
        if (!view.glossy) continue;
        of[lobes.count] = static_cast<std::uint16_t>(i);
        lobes.add(gbuffer_, tables_, pixel);
    }
    if (lobes.count == 0) return;
    find_lobes(tables_, gbuffer_.camera.position, false, lobes);
    for (int k = 0; k < lobes.count; ++k) {
        PixelViews::View& view = views.view[of[k]];
        view.direction = lobes.cone(k);
        view.albedo = lobes.albedo(k, gbuffer_.specular[view.pixel]);
        view.level = caches_.samples == 0 ? level_of(view.pixel, lobes.half_angle[k]) : 0.0f;
    }
}

}  // namespace interreflect
