// Spherical harmonics, cones and powers of the cosine in them, against quadrature over the sphere.
#include "math/spherical_harmonics.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>

using namespace interreflect;

namespace {

constexpr int bands = 8, count = bands * bands;
constexpr double exact_pi = 3.14159265358979323846;

struct Point {
    vec3 direction;
    double cosine, weight;
};

/// Midpoints in the angle about the axis, exact for the harmonics; Gauss-Legendre by Newton's method in the cosine from `low`
/// to 1.
std::vector<Point> sphere(double low) {
    constexpr int rings = 40, turns = 32;
    std::vector<Point> points;
    for (int i = 0; i < rings; ++i) {
        double x = std::cos(exact_pi * (i + 0.75) / (rings + 0.5)), slope = 1;
        for (int step = 0; step < 60; ++step) {
            double before = 1, now = x;
            for (int l = 2; l <= rings; ++l) {
                const double next = ((2 * l - 1) * x * now - (l - 1) * before) / l;
                before = now, now = next;
            }
            slope = rings * (x * now - before) / (x * x - 1);
            x -= now / slope;
        }
        const double half = (1 - low) / 2, weight = 2 / ((1 - x * x) * slope * slope) * half, z = low + half * (1 + x);
        for (int k = 0; k < turns; ++k) {
            const double turn = 2 * exact_pi * (k + 0.5) / turns, r = std::sqrt(std::max(1 - z * z, 0.0));
            points.push_back(
                {{static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)), static_cast<float>(z)},
                 z,
                 weight * 2 * exact_pi / turns});
        }
    }
    return points;
}

std::array<double, count> harmonics(const vec3& d) {
    std::array<double, count> y{};
    spherical_harmonics(d, bands, [&](int i, float value) { y[static_cast<std::size_t>(i)] = static_cast<double>(value); });
    return y;
}

/// Coefficients of f(cosine about z), from cosine `low` on.
std::array<double, count> project(double low, const std::function<double(double)>& f) {
    std::array<double, count> sum{};
    for (const Point& p : sphere(low)) {
        const auto y = harmonics(p.direction);
        for (std::size_t i = 0; i < count; ++i) sum[i] += f(p.cosine) * y[i] * p.weight;
    }
    return sum;
}

}  // namespace

TEST(SphericalHarmonics, AreOrthonormal) {
    std::array<std::array<double, count>, count> products{};
    for (const Point& p : sphere(-1)) {
        const auto y = harmonics(p.direction);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < count; ++k) products[i][k] += y[i] * y[k] * p.weight;
    }
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < count; ++k) EXPECT_NEAR(products[i][k], i == k ? 1 : 0, 1e-6) << i << ", " << k;
}

TEST(SphericalHarmonics, AddUpToTheLegendrePolynomialOfTheAngleBetweenTwoDirections) {
    const vec3 a = glm::normalize(vec3(1, 2, -3)), b = glm::normalize(vec3(-2, 1, 0.5f));
    const auto ya = harmonics(a), yb = harmonics(b);
    const double x = static_cast<double>(glm::dot(a, b));
    double before = 1, now = x;
    for (int l = 1; l < bands; ++l) {
        double sum = 0;
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) sum += ya[static_cast<std::size_t>(i)] * yb[static_cast<std::size_t>(i)];
        EXPECT_NEAR(sum, (2 * l + 1) / (4 * exact_pi) * now, 1e-6) << l;
        const double next = ((2 * l + 1) * x * now - l * before) / (l + 1);
        before = now, now = next;
    }
}

TEST(SphericalHarmonics, ConesAreProjectedExactly) {
    const auto pole = harmonics({0, 0, 1});
    for (const double angle : {1.0, 20.0, 60.0, 90.0, 150.0, 180.0}) {
        const double cosine = std::cos(angle * exact_pi / 180);
        const auto exact = project(cosine, [](double) { return 1.0; });
        for (int l = 0; l < bands; ++l) {
            const auto axis = static_cast<std::size_t>(l * l + l);
            EXPECT_NEAR(static_cast<double>(zonal_cone(l, static_cast<float>(1 - cosine))) * pole[axis], exact[axis], 1e-6)
                << "band " << l << ", " << angle << " degrees";
        }
    }
    // ERRATA.md: at 20 degrees.
    const float x = 1 - std::cos(20.0f * degrees_to_radians);
    EXPECT_NEAR(zonal_cone(0, x), 0.37892f, 1e-5f);
    EXPECT_NEAR(zonal_cone(1, x), 0.36750f, 1e-5f);
    EXPECT_NEAR(zonal_cone(2, x), 0.34533f, 1e-5f);
}

TEST(SphericalHarmonics, PowersOfTheCosineAreProjectedExactly) {
    const auto pole = harmonics({0, 0, 1});
    for (const double n : {1.0, 2.0, 7.5, 30.0, 150.0}) {
        const auto exact = project(0, [n](double c) { return (n + 1) / (2 * exact_pi) * std::pow(c, n); });
        for (int l = 0; l < bands; ++l) {
            const auto axis = static_cast<std::size_t>(l * l + l);
            EXPECT_NEAR(static_cast<double>(lobe_scale(l, static_cast<float>(n))) * pole[axis], exact[axis], 1e-6)
                << "band " << l << ", n " << n;
        }
    }
}

TEST(SphericalHarmonics, TheClampedCosinesBandsAreTheKnownOnes) {
    constexpr float known[] = {1, 2.0f / 3, 0.25f, 0, -1.0f / 24, 0, 1.0f / 64};
    for (int l = 0; l < 7; ++l) EXPECT_NEAR(lobe_scale(l, 1), known[l], 1e-7f) << l;
}

// GROUND_TRUTH.md, 16: a sun of unit irradiance, three bands.
TEST(SphericalHarmonics, ThreeBandsOfASunGiveTheKnownIrradiance) {
    const auto sun = harmonics({0, 0, 1});
    for (const auto& [degrees, irradiance] : {std::pair{0.0f, 1.0625}, {90.0f, 0.09375}, {180.0f, 0.0625}}) {
        const float angle = degrees * degrees_to_radians;
        const auto y = harmonics({std::sin(angle), 0, std::cos(angle)});
        double sum = 0;
        for (int l = 0; l < 3; ++l)
            for (int i = l * l; i < (l + 1) * (l + 1); ++i)
                sum += exact_pi * static_cast<double>(lobe_scale(l, 1)) * sun[static_cast<std::size_t>(i)] *
                       y[static_cast<std::size_t>(i)];
        EXPECT_NEAR(sum, irradiance, 1e-6) << degrees;
    }
}
