#include "caches/interpolate/pixel_views.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "caches/interpolate/view_lanes.h"
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

float PixelViewer::level_of(float cosine) const {
    const float solid_angle = 2.0f * pi * std::max(1.0f - cosine, 1e-8f);
    const float level = 0.5f * std::log2(solid_angle / map_texel_solid_angle(caches_.filled->resolution)) + caches_.level_bias;
    return std::clamp(level, 0.0f, static_cast<float>(caches_.levels() - 1));
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
        const std::uint32_t column = pixel % gbuffer_.width, row = pixel / gbuffer_.width;
        views.screen[0][i] = static_cast<float>(column) + 0.5f;
        views.screen[1][i] = static_cast<float>(row) + 0.5f;
    }
    look_up(views);
}

void PixelViewer::look_up(PixelViews& views) const {
    thread_local Reflections lobes;
    alignas(64) float specular[3][PixelViews::capacity];
    const int whole = (views.count + PixelViews::most_lanes - 1) / PixelViews::most_lanes * PixelViews::most_lanes;
    if (views.count > 0) std::fill(views.pixel + views.count, views.pixel + whole, views.pixel[views.count - 1]);
    const bool glossy = load_pixels(gbuffer_, views, lobes, specular);
    for (int k = 0; k < 3; ++k) {
        std::fill(views.position[k] + views.count, views.position[k] + whole, std::numeric_limits<float>::infinity());
        std::fill(specular[k] + views.count, specular[k] + whole, 0.0f);
    }
    bound_groups(views);
    lobes.count = views.count;
    for (int i = 0; i < views.count; ++i) {
        const bool lobe = std::max({specular[0][i], specular[1][i], specular[2][i]}) > 0.0f;
        lobes.table[i] = lobe ? tables_.first(views.pixel[i]) : 0;
    }
    if (glossy) find_lobes(tables_, gbuffer_.camera.position, false, lobes);
    enter_lobes(lobes, specular, only_level_.value_or(0.0f), views);
    if (glossy && !only_level_) find_levels(lobes, views);
    bound_levels(views);
}

void PixelViewer::find_levels(const Reflections& lobes, PixelViews& views) const {
    if (caches_.width == LobeWidth::resultant) {
        const LevelOfWidth width{map_texel_solid_angle(caches_.filled->resolution), caches_.level_bias,
                                 static_cast<float>(caches_.levels() - 1)};
        interreflect::find_levels(width, lobes.half_angle, views);
        return;
    }
    // The lobe that was last looked at, and its level: neighbours tend to have the same.
    PixelLobe last{Lobe::ggx, -1.0f};
    float alpha = -1.0f, level = 0.0f;
    for (int i = 0; i < views.count; ++i) {
        if (views.level[i] < 0.0f) continue;
        const std::uint32_t pixel = views.pixel[i];
        const PixelLobe of = lobe_at(gbuffer_, scene_.materials[scene_.material_of(gbuffer_.triangle[pixel])], pixel);
        if (of.lobe != last.lobe || lobes.alpha[i] != alpha || of.exponent != last.exponent) {
            last = of, alpha = lobes.alpha[i];
            level = level_of(one_percent_cosine(of.lobe, alpha, of.exponent));
        }
        views.level[i] = level;
    }
}

}  // namespace interreflect
