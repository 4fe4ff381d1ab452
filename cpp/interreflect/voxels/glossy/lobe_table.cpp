#include "voxels/glossy/lobe_table.h"

#include <algorithm>
#include <cmath>

#include "math/owen_sobol.h"
#include "shading/brdf.h"

namespace interreflect {
namespace {

constexpr int widths = LobeTable::widths, views = LobeTable::views, samples = 256;

float width_of(int i) { return std::max(static_cast<float>(i * i) / ((widths - 1) * (widths - 1)), 1e-3f); }
float view_of(int i) { return std::max(static_cast<float>(i) / (views - 1), 0.01f); }

SurfacePoint surface_with(Lobe lobe, float alpha, float specular) {
    SurfacePoint point;  // geometric and shading normal are +z
    point.lobe = lobe;
    point.alpha = alpha;
    point.exponent = std::max(2.0f / (alpha * alpha) - 2.0f, 0.0f);
    point.specular = vec3(specular);
    return point;
}

LobeCone integrate(Lobe lobe, float alpha, float cosine) {
    const vec3 wo(-std::sqrt(1.0f - cosine * cosine), 0, cosine);  // so that the mirrored view leans towards +x
    // Specular 1 is the lobe without Fresnel; a vanishing one leaves Schlick's (1 - cos)^5.
    const SurfacePoint full = surface_with(lobe, alpha, 1.0f), edge = surface_with(lobe, alpha, 1e-6f);
    vec3 mean(0);
    LobeCone cone;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const Bits2 bits = owen_sobol(i, 0x10be);
        const vec2 u(unit_float(bits.x), unit_float(bits.y));
        const BrdfSample sample = sample_brdf(full, wo, 0.0f, u);
        cone.scale += sample.weight.x / samples;
        if (has_microfacets(lobe)) cone.bias += sample_brdf(edge, wo, 0.0f, u).weight.x / samples;
        mean += sample.wi * (sample.weight.x / samples);
    }
    const float length = std::hypot(mean.x, mean.z);
    if (cone.scale <= 0.0f || length <= 0.0f) return cone;
    cone.direction = vec2(mean.x, mean.z) / length;
    cone.half_angle = std::acos(std::clamp(2.0f * std::min(length / cone.scale, 1.0f) - 1.0f, -1.0f, 1.0f));
    return cone;
}

}  // namespace

LobeTable::LobeTable(Lobe lobe) : entries_(widths * views) {
    // Not in parallel: a static's first use must not wait for work that may need it too.
    for (int width = 0; width < widths; ++width)
        for (int view = 0; view < views; ++view) entries_[width * views + view] = integrate(lobe, width_of(width), view_of(view));
}

namespace {
template <Lobe lobe>
const LobeTable& table_of() {
    static const LobeTable table(lobe);
    return table;
}
}  // namespace

const LobeTable& lobe_table(Lobe lobe) {
    switch (lobe) {
        case Lobe::phong:
            return table_of<Lobe::phong>();
        case Lobe::blinn_phong:
            return table_of<Lobe::blinn_phong>();
        case Lobe::freed_cook_torrance:
            return table_of<Lobe::freed_cook_torrance>();
        case Lobe::gaining_blinn_phong:
            return table_of<Lobe::gaining_blinn_phong>();
        case Lobe::ggx:
            break;
    }
    return table_of<Lobe::ggx>();
}

LobeTables::LobeTables(const GBuffer& gbuffer, const Scene& scene) : gbuffer_(&gbuffer), scene_(&scene) {
    first_.fill(-1);
    int lobes = 0;
    for (const auto& material : scene.materials) {
        if (!material.glossy()) continue;
        const Lobe lobe = gbuffer.lobe.value_or(material.lobe);
        int& first = first_[static_cast<std::size_t>(lobe)];
        if (first >= 0) continue;
        first = static_cast<int>(entries_.size());
        const auto table = lobe_table(lobe).entries();
        entries_.insert(entries_.end(), table.begin(), table.end());
        only_ = lobes++ == 0 ? first : -1;
    }
}

}  // namespace interreflect
