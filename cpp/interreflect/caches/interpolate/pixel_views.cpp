#include "caches/interpolate/pixel_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
    : gbuffer_(gbuffer), scene_(scene), caches_(caches), tables_(gbuffer, scene) {
    if (caches.samples > 0) only_level_ = 0.0f;
    if (caches.samples > 0 || caches.width == LobeWidth::resultant) return;
    for (const Material& material : scene.materials) {
        if (!material.glossy()) continue;
        const Lobe lobe = gbuffer.lobe.value_or(material.lobe);
        const float level = level_of(one_percent_cosine(lobe, 0.0f, material.exponent));
        // Such lobes are as wide as the pixel's alpha says.
        if (has_microfacets(lobe) || !(material.exponent > 0.0f) || level != only_level_.value_or(level)) {
            only_level_.reset();
            return;
        }
        only_level_ = level;
    }
}

/// The lobe that was last looked at, and its level: neighbours tend to have the same.
struct PixelViewer::Width {
    Lobe lobe = Lobe::ggx;
    float alpha = -1.0f, exponent = -1.0f, level = 0.0f;
};

float PixelViewer::level_of(float cosine) const {
    const float solid_angle = 2.0f * pi * std::max(1.0f - cosine, 1e-8f);
    const float level = 0.5f * std::log2(solid_angle / map_texel_solid_angle(caches_.filled->resolution)) + caches_.level_bias;
    return std::clamp(level, 0.0f, static_cast<float>(caches_.levels() - 1));
}

float PixelViewer::level_of(std::size_t pixel, float half_angle, Width& last) const {
    if (only_level_) return *only_level_;
    if (caches_.width == LobeWidth::resultant) return level_of(std::cos(half_angle));
    const PixelLobe of = lobe_at(gbuffer_, scene_.materials[scene_.material_of(gbuffer_.triangle[pixel])], pixel);
    const float alpha = gbuffer_.alpha[pixel];
    if (of.lobe != last.lobe || alpha != last.alpha || of.exponent != last.exponent)
        last = {of.lobe, alpha, of.exponent, level_of(one_percent_cosine(of.lobe, alpha, of.exponent))};
    return last.level;
}

void PixelViewer::look(const Tile& block, PixelViews& views) const {
    constexpr int side = 4;
    views.count = 0;
    for (int y0 = block.y0; y0 < block.y1; y0 += side)
        for (int x0 = block.x0; x0 < block.x1; x0 += side)
            for (int y = y0; y < std::min(y0 + side, block.y1); ++y)
                for (int x = x0; x < std::min(x0 + side, block.x1); ++x) {
                    const auto pixel = static_cast<std::uint32_t>(y * gbuffer_.width + x);
                    if (!gbuffer_.hit(pixel)) continue;
                    const int i = views.count++;
                    views.pixel[i] = pixel;
                    views.screen[0][i] = static_cast<float>(x) + 0.5f, views.screen[1][i] = static_cast<float>(y) + 0.5f;
                }
    look_up(views);
}

void PixelViewer::look(std::span<const std::uint32_t> pixels, PixelViews& views) const {
    views.count = static_cast<int>(pixels.size());
    for (int i = 0; i < views.count; ++i) {
        const std::uint32_t pixel = pixels[static_cast<std::size_t>(i)];
        views.pixel[i] = pixel;
        views.screen[0][i] = static_cast<float>(pixel % gbuffer_.width) + 0.5f;
        views.screen[1][i] = static_cast<float>(pixel / gbuffer_.width) + 0.5f;
    }
    look_up(views);
}

void PixelViewer::look_up(PixelViews& views) const {
    thread_local Reflections lobes;
    std::array<std::uint16_t, PixelViews::capacity> of;  // lobe -> view
    lobes.count = 0;
    for (int i = 0; i < views.count; ++i) {
        const std::uint32_t pixel = views.pixel[i];
        for (int k = 0; k < 3; ++k)
            views.position[k][i] = gbuffer_.position[pixel][k], views.normal[k][i] = gbuffer_.normal[pixel][k];
        views.level[i] = PixelViews::no_lobe;
        if (!(max_component(gbuffer_.specular[pixel]) > 0.0f)) continue;
        of[lobes.count] = static_cast<std::uint16_t>(i);
        lobes.add(gbuffer_, tables_, pixel);
    }
    for (int i = views.count; i % PixelViews::most_lanes != 0; ++i) {
        for (int k = 0; k < 3; ++k)
            views.position[k][i] = std::numeric_limits<float>::infinity(), views.normal[k][i] = views.direction[k][i] = 0.0f;
        views.screen[0][i] = views.screen[1][i] = 0.0f;
        views.level[i] = PixelViews::no_lobe;
    }
    bound_groups(views);
    views.finest = caches_.levels(), views.coarsest = -1;
    if (lobes.count == 0) return;
    find_lobes(tables_, gbuffer_.camera.position, false, lobes);
    Width last;
    for (int k = 0; k < lobes.count; ++k) {
        const int i = of[k];
        for (int axis = 0; axis < 3; ++axis) views.direction[axis][i] = lobes.direction[axis][k];
        views.albedo[i] = lobes.albedo(k, gbuffer_.specular[views.pixel[i]]);
        const float level = level_of(views.pixel[i], lobes.half_angle[k], last);
        views.level[i] = level;
        views.finest = std::min(views.finest, static_cast<int>(level));
        views.coarsest = std::max(views.coarsest, static_cast<int>(std::ceil(level)));
    }
}

}  // namespace interreflect
