#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "caches/fill/texels.h"
#include "caches/interpolate/cache_reader.h"
#include "caches/preconvolve.h"
#include "math/hemisphere_map.h"
#include "math/rng.h"

namespace interreflect {
namespace {

using Radiance = std::function<float(const vec3&)>;

/// One cache of n x n texels, each the mean of 8 x 8 directions; a quarter open.
std::shared_ptr<const FilledCaches> one_cache(int n, const Radiance& radiance) {
    auto places = std::make_shared<CachePlaces>();
    places->position = Buffer<vec3>(1, vec3(0)), places->normal = Buffer<vec3>(1, vec3(0, 0, 1));
    FilledCaches filled;
    filled.resolution = n;
    filled.texels = Buffer<std::uint16_t>(4 * static_cast<std::size_t>(n) * n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            float sum = 0;
            for (int i = 0; i < 64; ++i)
                sum += radiance(hemisphere_direction(map_texel_centre(8 * x + i % 8, 8 * y + i / 8, 8 * n)));
            write_texel(filled.texels.data() + 4 * (y * n + x), vec3(sum / 64), 0.25f);
        }
    filled.places = std::move(places);
    return std::make_shared<const FilledCaches>(std::move(filled));
}

vec4 mean(const std::uint16_t* texels, int count) {
    vec4 sum(0);
    for (int i = 0; i < count; ++i) sum += read_texel(texels + 4 * i);
    return sum / static_cast<float>(count);
}

float smooth(const vec3& d) { return 1.0f + 0.5f * d.x + 0.3f * d.y * d.z; }
float half_space(const vec3& d) { return d.x > 0.2f ? 1.0f : 0.0f; }
float small_patch(const vec3& d) { return glm::dot(d, glm::normalize(vec3(1, 1, 2))) > 0.97f ? 10.0f : 0.1f; }

const int sizes[] = {1, 2, 3, 5, 7, 8, 15, 16, 32};

TEST(MipChain, KeepsAConstantAtEveryLevelAndInTheTable) {
    for (const int n : sizes) {
        const ConvolvedCaches caches = preconvolve(MipChain{}, one_cache(n, [](const vec3&) { return 0.7f; }));
        const LayerMaps maps(caches, caches.filled->texels, caches.light, 0);
        const auto expect_constant = [](const std::uint16_t* texels, int count) {
            for (int i = 0; i < count; ++i) {
                // Three roundings to half floats, of one part in 2048 each.
                EXPECT_NEAR(read_texel(texels + 4 * i).x, 0.7f, 1e-3f);
                EXPECT_NEAR(read_texel(texels + 4 * i).w, 0.25f, 4e-4f);
            }
        };
        for (int level = 0; level < caches.levels(); ++level)
            expect_constant(maps.level(level), caches.level_sizes[level] * caches.level_sizes[level]);
        expect_constant(maps.table, caches.table_size * caches.table_size);
        EXPECT_EQ(caches.level_sizes.back(), 1);
    }
}

TEST(MipChain, KeepsEnergyFromLevelToLevelAtAnySize) {
    for (const auto& radiance : {smooth, half_space, small_patch})
        for (const int n : sizes) {
            const ConvolvedCaches caches = preconvolve(MipChain{}, one_cache(n, radiance));
            const LayerMaps maps(caches, caches.filled->texels, caches.light, 0);
            const vec4 whole = mean(maps.level(0), n * n);
            for (int level = 1; level < caches.levels(); ++level) {
                const vec4 here = mean(maps.level(level), caches.level_sizes[level] * caches.level_sizes[level]);
                EXPECT_NEAR(here.x, whole.x, 1e-3f * whole.x) << n << " level " << level;  // half floats
                EXPECT_NEAR(here.w, whole.w, 4e-4f);
            }
        }
}

/// Mean over a lobe, as far as it lies above the cache's horizon.
float mean_over(const Radiance& radiance, const std::function<float(const vec3&)>& lobe) {
    constexpr int n = 64;
    double sum = 0, weight = 0;
    for (int i = 0; i < n * n; ++i) {
        const vec3 d = hemisphere_direction(map_texel_centre(i % n, i / n, n));
        const float w = lobe(d);
        sum += static_cast<double>(w) * radiance(d), weight += w;
    }
    return static_cast<float>(sum / weight);
}

/// Root mean square error of the table over normals within 60 degrees of the cache's, over the mean radiance.
float table_error(int table, const Radiance& radiance, int resolution = 16) {
    const ConvolvedCaches caches = preconvolve(MipChain{table}, one_cache(resolution, radiance));
    const LayerMaps maps(caches, caches.filled->texels, caches.light, 0);
    double squared = 0;
    constexpr int count = 40;
    for (int i = 0; i < count; ++i) {
        const float z = 1.0f - 0.5f * (static_cast<float>(i) + 0.5f) / count, r = std::sqrt(1 - z * z),
                    turn = 2.39996f * static_cast<float>(i);
        const vec3 normal(r * std::cos(turn), r * std::sin(turn), z);
        const float exact = mean_over(radiance, [&](const vec3& d) { return std::max(glm::dot(d, normal), 0.0f); });
        const float error = read_map(maps.table, table, hemisphere_square(normal)).x - exact;
        squared += static_cast<double>(error) * error;
    }
    return static_cast<float>(std::sqrt(squared / count)) / mean_over(radiance, [](const vec3&) { return 1.0f; });
}

TEST(MipChain, HoldsTheCosineLobesIntegralInItsTable) {
    const vec3 axis = glm::normalize(vec3(1, 0, 1));
    const auto cosine = [&](const vec3& d) { return std::max(glm::dot(d, axis), 0.0f); };
    // Measured .016, .019, .005: a table of 5 x 5 has one and a half times that, one of 9 x 9 two thirds.
    EXPECT_LT(table_error(7, cosine), 0.02f);
    EXPECT_LT(table_error(7, half_space), 0.023f);
    EXPECT_LT(table_error(7, smooth), 0.008f);
    for (const Radiance& radiance : {Radiance(cosine), Radiance(half_space), Radiance(small_patch)})
        EXPECT_LT(table_error(7, radiance), 0.8f * table_error(5, radiance));
}

TEST(MipChain, WeightsEveryTexelOfAFineMapByItsCosineInTheLobeAboutTheCachesNormal) {
    const auto horizon = [](const vec3& d) { return d.z < 0.06f ? 1.0f : 0.0f; };
    for (const int n : {16, 32, 64}) {
        const ConvolvedCaches caches = preconvolve(MipChain{7}, one_cache(n, horizon));
        const LayerMaps maps(caches, caches.filled->texels, caches.light, 0);
        float sum = 0, weight = 0;
        for (int i = 0; i < 64 * n * n; ++i) {
            const int x = i % (8 * n), y = i / (8 * n);
            const float cosine = hemisphere_direction(map_texel_centre(x, y, 8 * n)).z;
            sum += read_texel(maps.level(0) + 4 * (y / 8 * n + x / 8)).x * cosine, weight += cosine;
        }
        // Half floats, and mean cosines of 4 x 4 directions a texel.
        EXPECT_NEAR(read_map(maps.table, 7, vec2(0.5f)).x, sum / weight, 0.01f * sum / weight) << n;
    }
}

/// Root mean square error of Phong lobes read from the chain, over that of their mean.
float lobe_error(const Radiance& radiance, float exponent, bool resultant, float bias) {
    const ConvolvedCaches caches = preconvolve(MipChain{}, one_cache(16, radiance));
    const LayerMaps maps(caches, caches.filled->texels, caches.light, 0);
    const float cosine = resultant ? 2.0f * (exponent + 1) / (exponent + 2) - 1.0f : one_percent_cosine(Lobe::phong, 0, exponent);
    const float area = 2.0f * pi * (1 - cosine) / map_texel_solid_angle(16);
    const float level = std::clamp(0.5f * std::log2(area) + bias, 0.0f, static_cast<float>(caches.levels() - 1));
    double squared = 0, sum = 0;
    constexpr int count = 40;
    for (int i = 0; i < count; ++i) {
        const float z = 1.0f - 0.8f * (static_cast<float>(i) + 0.5f) / count, r = std::sqrt(1 - z * z),
                    turn = 2.39996f * static_cast<float>(i);
        const vec3 mirrored(r * std::cos(turn), r * std::sin(turn), z);
        const float exact =
            mean_over(radiance, [&](const vec3& d) { return std::pow(std::max(glm::dot(d, mirrored), 0.0f), exponent); });
        const vec2 square = hemisphere_square(mirrored);
        const int finer = static_cast<int>(level), coarser = std::min(finer + 1, caches.levels() - 1);
        const float read =
            glm::mix(read_map(maps.level(finer), caches.level_sizes[finer], square).x,
                     read_map(maps.level(coarser), caches.level_sizes[coarser], square).x, level - static_cast<float>(finer));
        squared += static_cast<double>(read - exact) * (read - exact), sum += static_cast<double>(exact) * exact;
    }
    return static_cast<float>(std::sqrt(squared / sum));
}

TEST(MipChain, ReadsLobesOfItsDefaultWidthToATenthOfAStepAndBetterThanThePapers) {
    const MipChain own;
    ASSERT_EQ(own.width, "resultant");
    for (const float exponent : {5.0f, 10.0f, 20.0f, 50.0f, 100.0f, 200.0f}) {
        const auto error = [&](const Radiance& radiance) {
            return lobe_error(radiance, exponent, true, static_cast<float>(own.level_bias));
        };
        EXPECT_LT(error(smooth), 0.03f) << exponent;
        EXPECT_LT(error(half_space), 0.12f) << exponent;
        const auto papers = [&](const Radiance& radiance) { return lobe_error(radiance, exponent, false, 0.0f); };
        EXPECT_LT(error(smooth), 0.6f * papers(smooth)) << exponent;
        EXPECT_LT(error(half_space), 0.6f * papers(half_space)) << exponent;
        // What is far narrower than the widest lobes they all misjudge.
        EXPECT_LT(error(small_patch), (exponent < 10 ? 1.0f : 0.6f) * papers(small_patch)) << exponent;
    }
}

TEST(OnePercentCosine, IsWhereTheLobeHasFallenToOnePercentOfItsPeak) {
    for (const float exponent : {1.0f, 7.0f, 50.0f, 500.0f}) {
        const float cosine = one_percent_cosine(Lobe::phong, 0.3f, exponent);
        EXPECT_NEAR(std::pow(cosine, exponent), 0.01f, 1e-5f * exponent);  // of a float near 1, to the exponent
    }
    // Seen from straight above, light that leaves at an angle has its half vector at half of that.
    for (const float exponent : {20.0f, 50.0f, 500.0f}) {
        const float half = 0.5f * std::acos(one_percent_cosine(Lobe::blinn_phong, 0.3f, exponent));
        EXPECT_NEAR(std::pow(std::cos(half), exponent), 0.01f, 1e-5f * exponent);
    }
    for (const float alpha : {0.01f, 0.05f, 0.1f, 0.2f}) {
        const float half = 0.5f * std::acos(one_percent_cosine(Lobe::ggx, alpha, 0));
        const float a2 = alpha * alpha, c2 = std::cos(half) * std::cos(half), peak = 1 / a2;
        const float d = a2 / ((c2 * (a2 - 1) + 1) * (c2 * (a2 - 1) + 1));
        EXPECT_NEAR(d / peak, 0.01f, 2e-4f);
    }
    EXPECT_EQ(one_percent_cosine(Lobe::phong, 1, 0), 0.0f);
    EXPECT_EQ(one_percent_cosine(Lobe::ggx, 1, 0), 0.0f);
    EXPECT_EQ(one_percent_cosine(Lobe::blinn_phong, 1, 0), 0.0f);
}

}  // namespace
}  // namespace interreflect
