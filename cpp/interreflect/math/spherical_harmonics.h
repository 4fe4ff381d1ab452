/// Real spherical harmonics y_l^m, orthonormal over the sphere, without the Condon-Shortley sign; coefficient (l, m) is number
/// l^2 + l + m. And what is symmetric about an axis: cones and powers of the cosine.
#pragma once
#include <array>
#include <cmath>

#include "math/vectors.h"

namespace interreflect {

namespace detail {
constexpr int most_harmonic_bands = 8;
/// sqrt((2l + 1) / 4pi (l - m)! / (l + m)!), twice its square for m > 0: the norm of the Legendre function.
inline const std::array<std::array<float, most_harmonic_bands>, most_harmonic_bands>& harmonic_norms() {
    static const auto table = [] {
        std::array<std::array<float, most_harmonic_bands>, most_harmonic_bands> norms{};
        for (int l = 0; l < most_harmonic_bands; ++l)
            for (int m = 0; m <= l; ++m) {
                double ratio = m == 0 ? 1.0 : 2.0;
                for (int k = l - m + 1; k <= l + m; ++k) ratio /= k;
                norms[static_cast<std::size_t>(l)][static_cast<std::size_t>(m)] =
                    static_cast<float>(std::sqrt((2 * l + 1) / (4 * 3.14159265358979323846) * ratio));
            }
        return norms;
    }();
    return table;
}
}  // namespace detail

/// Calls store(l^2 + l + m, y_l^m(d)) for all of `bands` bands (1 to 8). d: unit.
template <class Store>
void spherical_harmonics(const vec3& d, int bands, const Store& store) {
    const auto& norms = detail::harmonic_norms();
    // (x + iy)^m carries the sine's power, so what is left of the Legendre function is a polynomial of z.
    float cosine = 1.0f, sine = 0.0f, diagonal = 1.0f;
    for (int m = 0; m < bands; ++m) {
        float before = 0.0f, now = diagonal;
        for (int l = m; l < bands; ++l) {
            const float value = norms[static_cast<std::size_t>(l)][static_cast<std::size_t>(m)] * now;
            const int middle = l * l + l;
            store(middle + m, value * cosine);
            if (m > 0) store(middle - m, value * sine);
            const float next =
                (static_cast<float>(2 * l + 1) * d.z * now - static_cast<float>(l + m) * before) / static_cast<float>(l + 1 - m);
            before = now, now = next;
        }
        diagonal *= static_cast<float>(2 * m + 1);
        const float turned = d.x * cosine - d.y * sine;
        sine = d.x * sine + d.y * cosine;
        cosine = turned;
    }
}

/// What a cone of half angle a projects to: c_l^m = zonal_cone(l, 1 - cos a) y_l^m(axis) [Jendersie et al. 2016, appendix C]. The
/// paper prints three signs wrongly and forgets the norm, with which equation 5's root is already in it (ERRATA). Evaluated by
/// the cone's complement x = 1 - cos a: pi x times a polynomial, which keeps small cones exact.
inline float zonal_cone(int l, float x) {
    const float c = 1.0f - x, c2 = c * c, s2 = x * (2.0f - x);  // cosine, and sine squared
    switch (l) {
        case 0:
            return 2.0f * pi * x;
        case 1:
            return pi * s2;
        case 2:
            return pi * c * s2;
        case 3:
            return pi / 4.0f * s2 * (5.0f * c2 - 1.0f);
        case 4:
            return pi / 4.0f * s2 * c * (7.0f * c2 - 3.0f);
        case 5:
            return pi / 8.0f * s2 * ((21.0f * c2 - 14.0f) * c2 + 1.0f);
        case 6:
            return pi / 8.0f * s2 * c * ((33.0f * c2 - 30.0f) * c2 + 5.0f);
        default:
            return pi / 64.0f * s2 * (((429.0f * c2 - 495.0f) * c2 + 135.0f) * c2 - 5.0f);
    }
}

/// The lobe (n + 1) / 2pi cos^n about an axis projects to c_l^m = lobe_scale(l, n) y_l^m(axis) [Jendersie et al. 2016, equations
/// 4, 5, 9 and appendix B]. With n = 1 it is the clamped cosine over pi.
inline float lobe_scale(int l, float n) {
    float scale = l % 2 == 0 ? 1.0f : (n + 1.0f) / (n + 2.0f);
    for (int k = l % 2 + 2; k <= l; k += 2) scale *= (n + 2.0f - static_cast<float>(k)) / (n + 1.0f + static_cast<float>(k));
    return scale;
}

}  // namespace interreflect
