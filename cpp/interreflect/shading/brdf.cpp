#include "shading/brdf.h"

#include "math/sampling.h"

namespace interreflect {
namespace {

float squared(float x) { return x * x; }

/// What the lobes need of a pair of directions. `half` lies on the normal's side.
struct Angles {
    float cos_o, cos_i, cos_half, sin2_half, cos_o_half;
};
Angles angles(const vec3& n, const vec3& wo, const vec3& wi) {
    const vec3 sum = wo + wi;
    const float length = glm::length(sum);
    vec3 half = length > 0.0f ? sum / length : n;
    if (glm::dot(n, half) < 0.0f) half = -half;
    // The sine from the cross product: 1 - cos^2 has no digits left for the narrow lobes.
    const vec3 across = glm::cross(n, half);
    return {glm::dot(n, wo), glm::dot(n, wi), glm::dot(n, half), glm::dot(across, across), glm::dot(wo, half)};
}

vec3 schlick(const vec3& specular, float cosine) {
    const float m = glm::min(glm::max(1.0f - cosine, 0.0f), 1.0f);
    return specular + (vec3(1) - specular) * (m * m * m * m * m);
}

float ggx_distribution(float alpha, const Angles& a) {
    const float a2 = alpha * alpha, d = a2 * a.cos_half * a.cos_half + a.sin2_half;
    return a2 / (pi * d * d);
}
/// Of half vectors per solid angle of the light.
float half_vectors(const Angles& a) { return 1.0f / (4.0f * glm::max(a.cos_o_half, 1e-6f)); }
/// Its mean over light that fills a circle. Slopes have the density alpha^2 / (pi (alpha^2 + t^2)^2): what a circle of radius r
/// about slope t holds is the form factor of a disk for an element at distance alpha, t aside of its axis [Howell 2010, B-12].
/// With S^2 = (alpha^2 + t^2 - r^2)^2 + 4 alpha^2 r^2; all lengths times the cosine.
float mean_ggx_distribution(float alpha, const Angles& a, float solid_angle) {
    const float a2 = squared(alpha), cosine = glm::max(a.cos_half, 1e-6f), r2 = solid_angle * half_vectors(a) / (pi * cosine);
    const float q = a2 * cosine * cosine + a.sin2_half - r2, s = std::sqrt(q * q + 4.0f * a2 * r2 * cosine * cosine);
    return q > 0.0f ? 2.0f * a2 / (pi * s * (s + q)) : (s - q) / (2.0f * pi * s * r2 * cosine * cosine);
}
/// Of the lobe whose middle has the mean of (n + 1) / (2 pi) cos^n over a circle about its middle.
float widened_exponent(float n, float solid_angle) {
    const float below = glm::min(solid_angle / (2.0f * pi), 1.0f);  // 1 - cosine of the rim
    return below > 0.0f ? -std::expm1((n + 1.0f) * std::log1p(-glm::min(below, 0.999999f))) / below - 1.0f : n;
}

/// sqrt(alpha^2 sin^2 + cos^2), the root in Smith's shadowing.
float smith_root(float alpha, float cosine) { return std::sqrt(squared(alpha) + (1.0f - squared(alpha)) * squared(cosine)); }

float phong_cosine(const SurfacePoint& p, const vec3& wo, const vec3& wi) {
    const vec3 mirror = 2.0f * glm::dot(p.normal, wo) * p.normal - wo;
    return glm::max(0.0f, glm::dot(mirror, wi));
}
/// Scale of the Blinn-Phong lobe for which it reflects everything at normal view.
float blinn_phong_scale(float n) { return (n + 2.0f) * (n + 4.0f) / (8.0f * pi * (std::exp2(-0.5f * n) + n)); }

/// Schlick's approximation of Smith's shadowing over the cosine [Freed 2018, 4.5.1]. The paper writes one alpha for the k here
/// and for D; k takes the roughness, D its square (ERRATA).
float schlick_shadowing_over_cosine(float k, float cosine) { return 1.0f / (cosine * (1.0f - k) + k); }
/// D F G / (4 cos cos): with D normalised the paper's pi in the place of 4 would be 1.273 times too bright (ERRATA).
vec3 freed_cook_torrance(const SurfacePoint& p, const Angles& a, float distribution) {
    const float k = squared(std::sqrt(p.alpha) + 1.0f) / 8.0f;
    const float shadowing = schlick_shadowing_over_cosine(k, a.cos_o) * schlick_shadowing_over_cosine(k, a.cos_i);
    return schlick(p.specular, a.cos_o_half) * (distribution * shadowing * 0.25f);
}

/// `n`: its exponent; `distribution`: of microfacets.
vec3 lobe_value(const SurfacePoint& p, const vec3& wo, const vec3& wi, const Angles& a, float n, float distribution) {
    switch (p.lobe) {
        case Lobe::phong:
            return p.specular * ((n + 2.0f) / (2.0f * pi) * std::pow(phong_cosine(p, wo, wi), n));
        case Lobe::blinn_phong:
            return p.specular * (blinn_phong_scale(n) * std::pow(a.cos_half, n));
        case Lobe::gaining_blinn_phong:
            return p.specular * ((n + 8.0f) / (8.0f * pi) * std::pow(a.cos_half, n));
        case Lobe::freed_cook_torrance:
            return freed_cook_torrance(p, a, distribution);
        case Lobe::ggx:
            break;
    }
    // Height-correlated Smith over 4 cos cos [Heitz 2014, eq. 99].
    const float masking = 0.5f / (a.cos_i * smith_root(p.alpha, a.cos_o) + a.cos_o * smith_root(p.alpha, a.cos_i));
    return schlick(p.specular, a.cos_o_half) * (distribution * masking);
}

vec3 lobe_value(const SurfacePoint& p, const vec3& wo, const vec3& wi, const Angles& a) {
    return lobe_value(p, wo, wi, a, p.exponent, has_microfacets(p.lobe) ? ggx_distribution(p.alpha, a) : 0.0f);
}
vec3 mean_lobe_value(const SurfacePoint& p, const vec3& wo, const vec3& wi, const Angles& a, float solid_angle) {
    if (has_microfacets(p.lobe)) return lobe_value(p, wo, wi, a, p.exponent, mean_ggx_distribution(p.alpha, a, solid_angle));
    // Phong's is about the mirrored direction, the others' about the normal.
    const float covered = p.lobe == Lobe::phong ? solid_angle : solid_angle * half_vectors(a);
    return lobe_value(p, wo, wi, a, widened_exponent(p.exponent, covered), 0.0f);
}

float lobe_pdf(const SurfacePoint& p, const vec3& wo, const vec3& wi, const Angles& a) {
    const float n = p.exponent;
    switch (p.lobe) {
        case Lobe::phong:
            return (n + 1.0f) / (2.0f * pi) * std::pow(phong_cosine(p, wo, wi), n) *
                   (glm::dot(p.normal, wo) > 0.0f ? 1.0f : 0.0f);
        case Lobe::blinn_phong:
        case Lobe::gaining_blinn_phong:
            return (n + 1.0f) / (2.0f * pi) * std::pow(a.cos_half, n) / glm::max(4.0f * std::fabs(a.cos_o_half), 1e-12f);
        case Lobe::ggx:
        case Lobe::freed_cook_torrance:
            break;
    }
    if (a.cos_o_half <= 0.0f) return 0.0f;
    // Visible normals: G1 D / (4 cos) [Heitz 2018].
    return ggx_distribution(p.alpha, a) / (2.0f * (a.cos_o + smith_root(p.alpha, a.cos_o)));
}

/// Visible normal by a spherical cap [Dupuy and Benyoub 2023], in the frame of the shading normal.
vec3 sample_visible_normal(const vec3& wo, float alpha, const vec2& u) {
    const vec3 stretched = glm::normalize(vec3(wo.x * alpha, wo.y * alpha, wo.z));
    const float phi = 2.0f * pi * u.x, z = (1.0f - u.y) * (1.0f + stretched.z) - stretched.z;
    const float r = std::sqrt(glm::max(0.0f, 1.0f - z * z));
    const vec3 h = vec3(r * std::cos(phi), r * std::sin(phi), z) + stretched;
    return glm::normalize(vec3(h.x * alpha, h.y * alpha, glm::max(h.z, 1e-12f)));
}

/// Density (n + 1) / (2 pi) cos^n about +z.
vec3 sample_cosine_power(float n, const vec2& u) {
    const float c = std::pow(1.0f - u.x, 1.0f / (n + 1.0f)), s = std::sqrt(glm::max(0.0f, 1.0f - c * c)), phi = 2.0f * pi * u.y;
    return {s * std::cos(phi), s * std::sin(phi), c};
}

vec3 sample_lobe(const SurfacePoint& p, const vec3& wo, const vec2& u) {
    const vec3 n = p.normal;
    if (p.lobe == Lobe::phong) {
        const vec3 mirror = 2.0f * glm::dot(n, wo) * n - wo;
        return Frame(glm::normalize(mirror)).to_world(sample_cosine_power(p.exponent, u));
    }
    const Frame frame(n);
    const vec3 half = frame.to_world(has_microfacets(p.lobe) ? sample_visible_normal(frame.to_local(wo), p.alpha, u)
                                                             : sample_cosine_power(p.exponent, u));
    return 2.0f * glm::dot(wo, half) * half - wo;
}

/// Probability of choosing the glossy lobe; negative where nothing is reflected.
float glossy_share(const SurfacePoint& p, float cos_o) {
    const float diffuse = luminance(p.albedo);
    if (max_component(p.specular) <= 0.0f) return diffuse > 0.0f ? 0.0f : -1.0f;
    const float glossy = luminance(has_microfacets(p.lobe) ? schlick(p.specular, cos_o) : p.specular);
    return glossy / (glossy + diffuse);
}

/// The same without a lobe: most surfaces, and much cheaper.
BrdfValue diffuse_value(const SurfacePoint& p, const vec3& wo, const vec3& wi, float cos_o) {
    const float cos_i = glm::dot(p.normal, wi);
    if (cos_o <= 0.0f || cos_i <= 0.0f || max_component(p.albedo) <= 0.0f) return {};
    const bool above = glm::dot(p.geometric_normal, wo) > 0.0f && glm::dot(p.geometric_normal, wi) > 0.0f;
    return {above ? p.albedo * (1.0f / pi) : vec3(0), cos_i * (1.0f / pi)};
}

}  // namespace

BrdfValue evaluate_brdf_and_pdf(const SurfacePoint& p, const vec3& wo, const vec3& wi) {
    const float cos_o = glm::dot(p.normal, wo);
    if (max_component(p.specular) <= 0.0f) return diffuse_value(p, wo, wi, cos_o);
    const float share = cos_o > 0.0f ? glossy_share(p, cos_o) : -1.0f;
    if (share < 0.0f) return {};
    const float cos_i = glm::dot(p.normal, wi);
    BrdfValue result;
    result.pdf = (1.0f - share) * glm::max(cos_i, 0.0f) / pi;
    const bool above = cos_i > 0.0f && glm::dot(p.geometric_normal, wo) > 0.0f && glm::dot(p.geometric_normal, wi) > 0.0f;
    if (above) result.value = p.albedo / pi;
    if (share <= 0.0f) return result;
    const Angles a = angles(p.normal, wo, wi);
    result.pdf += share * lobe_pdf(p, wo, wi, a);
    if (above) result.value += lobe_value(p, wo, wi, a);
    return result;
}

vec3 evaluate_brdf(const SurfacePoint& point, const vec3& wo, const vec3& wi) {
    return evaluate_brdf_and_pdf(point, wo, wi).value;
}

vec3 mean_brdf(const SurfacePoint& p, const vec3& wo, const vec3& wi, float solid_angle) {
    const bool above = glm::dot(p.normal, wo) > 0.0f && glm::dot(p.normal, wi) > 0.0f &&
                       glm::dot(p.geometric_normal, wo) > 0.0f && glm::dot(p.geometric_normal, wi) > 0.0f;
    if (!above) return vec3(0);
    vec3 value = p.albedo / pi;
    if (max_component(p.specular) > 0.0f) value += mean_lobe_value(p, wo, wi, angles(p.normal, wo, wi), solid_angle);
    return value;
}

float brdf_pdf(const SurfacePoint& point, const vec3& wo, const vec3& wi) { return evaluate_brdf_and_pdf(point, wo, wi).pdf; }

BrdfSample sample_brdf(const SurfacePoint& p, const vec3& wo, float choose, const vec2& u) {
    const float cos_o = glm::dot(p.normal, wo);
    const float share = cos_o > 0.0f ? glossy_share(p, cos_o) : -1.0f;
    if (share < 0.0f) return {};
    BrdfSample sample;
    sample.wi = choose < share ? sample_lobe(p, wo, u) : Frame(p.normal).to_world(cosine_hemisphere(u));
    sample.wi = glm::normalize(sample.wi);
    const BrdfValue value = evaluate_brdf_and_pdf(p, wo, sample.wi);
    sample.pdf = value.pdf;
    if (value.pdf > 0.0f) sample.weight = value.value * (glm::max(0.0f, glm::dot(p.normal, sample.wi)) / value.pdf);
    return sample;
}

}  // namespace interreflect
