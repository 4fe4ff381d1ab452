#include <glm/gtc/packing.hpp>

#include <gtest/gtest.h>

#include "math/rng.h"
#include "math/sampling.h"
#include "shading/share.h"
#include "voxels/glossy/reflections.h"
#include "voxels/march/cone_set.h"
#include "voxels/march/march_cones.h"

namespace interreflect {
namespace {

/// A pyramid of one value everywhere, 2^(levels - 1) voxels on a side.
Pyramid uniform_pyramid(int levels, const vec4& value, int faces = 1) {
    Pyramid pyramid;
    pyramid.domain.cells = ivec3(1 << (levels - 1));
    pyramid.faces = faces;
    for (int i = 0; i < levels; ++i) {
        Pyramid::Level level;
        level.size = ivec3(1 << (levels - 1 - i));
        level.faces = i == 0 ? 1 : faces;
        level.texels = Buffer<std::uint16_t>(4 * level.volume() * level.faces);
        for (std::size_t t = 0; t < level.texels.size(); ++t) level.texels[t] = glm::packHalf1x16(value[static_cast<int>(t % 4)]);
        pyramid.levels.push_back(std::move(level));
    }
    return pyramid;
}

ConeBatch random_cones(const Pyramid& pyramid, int count) {
    ConeBatch batch{};
    Rng rng(7, 1);
    batch.count = count;
    for (int i = 0; i < count; ++i) {
        const vec3 at = vec3(rng.uniform(), rng.uniform(), rng.uniform()) * vec3(pyramid.domain.cells);
        set_start(batch, i, pyramid.domain, at, {0, 0, 1}, 0.0f, true);
        set_direction(batch, i, uniform_sphere({rng.uniform(), rng.uniform()}));
    }
    return batch;
}

TEST(ConeSets, OfTheCosineKindIntegrateTheCosineExactly) {
    for (const int count : {3, 4, 5, 6, 8, 12, 24, 100, 256})
        for (const float degrees : {0.0f, 10.0f, 30.0f, 70.0f}) {
            const ConeSet set = cosine_cones(count, degrees * degrees_to_radians);
            float weight = 0;
            for (const auto& cone : set.cones) {
                weight += cone.weight;
                EXPECT_GT(cone.direction.z, 0.0f);
                EXPECT_NEAR(glm::length(cone.direction), 1.0f, 1e-6f);
            }
            EXPECT_EQ(set.cones.size(), static_cast<std::size_t>(count));
            EXPECT_NEAR(weight, 1.0f, 1e-5f);
            EXPECT_NEAR(set.mean_cosine(), 2.0f / 3.0f, 1e-5f) << count << " cones of " << degrees;
        }
}

TEST(ConeSets, OfThePapersGiveWhatTheErrataSay) {
    EXPECT_NEAR(freed_thesis_cones().mean_cosine(), 0.7365f, 1e-4f);  // ERRATA: instead of .6667
    EXPECT_EQ(freed_thesis_cones().cones.size(), 5U);
    EXPECT_EQ(six_60_cones().cones.size(), 6U);
}

TEST(ConeSchedules, AdvanceEvenWithoutAnAperture) {
    const Pyramid pyramid = uniform_pyramid(5, vec4(0));
    const ConeSchedule schedule = make_schedule({0.0f, 0.75f, 0.5f, 0.0f, 1.0f}, pyramid);
    ASSERT_GT(schedule.steps.size(), 10U);
    for (std::size_t i = 1; i < schedule.steps.size(); ++i)
        EXPECT_NEAR(schedule.steps[i].distance - schedule.steps[i - 1].distance, 0.375f, 1e-4f);
}

TEST(ConeSchedules, FromAHeightAreTheListings) {
    // Freed 2018, listing 4.1, with an aperture of 45 degrees, coneHeight 1.5 and lodOffset .25.
    const Pyramid pyramid = uniform_pyramid(9, vec4(0));
    const float half_angle = 22.5f * degrees_to_radians;
    const ConeShape shape{.half_angle = half_angle,
                          .first_diameter = 0.25f,
                          .step = 0.5f,
                          .level_bias = 0.25f,
                          .start = ConeShape::Start::height,
                          .start_height = 1.5f,
                          .most_steps = 12,
                          .opacity_correction = false};
    const ConeSchedule schedule = make_schedule(shape, pyramid);
    ASSERT_EQ(schedule.steps.size(), 12U);
    float height = 1.5f;
    for (const auto& step : schedule.steps) {
        const float radius = height * std::tan(half_angle);
        EXPECT_NEAR(step.distance, height, 1e-4f * height);
        EXPECT_NEAR(static_cast<float>(step.level) + step.blend, std::log2(std::max(1.0f, 2 * radius)) + 0.25f, 1e-4f);
        EXPECT_EQ(step.exponent, 1.0f);  // color += (1 - alpha) * sample
        height += radius;
    }
}

TEST(ConeSchedules, FromAHeightAdvanceEvenWithoutAnAperture) {
    const Pyramid pyramid = uniform_pyramid(5, vec4(0));
    const ConeSchedule schedule = make_schedule(
        {.half_angle = 0.0f, .first_diameter = 0.75f, .start = ConeShape::Start::height, .start_height = 0.0f}, pyramid);
    ASSERT_GT(schedule.steps.size(), 10U);
    for (std::size_t i = 1; i < schedule.steps.size(); ++i)
        EXPECT_NEAR(schedule.steps[i].distance - schedule.steps[i - 1].distance, 0.375f, 1e-4f);
}

TEST(ConeSchedules, StartAsRaysUntilTheyAreAVoxelWide) {
    const Pyramid pyramid = uniform_pyramid(8, vec4(0));
    const float half_angle = 0.05f, slope = 2.0f * std::tan(half_angle);
    const ConeSchedule schedule = make_schedule({.half_angle = half_angle, .start = ConeShape::Start::rays}, pyramid);
    float begin = 0;
    for (const auto& step : schedule.steps) {
        const float diameter = std::max(1.0f, slope * begin);
        // The last step as a ray may begin just before the cone is a voxel wide.
        EXPECT_NEAR(step.distance, begin + 0.25f * diameter, 1e-3f * (1 + begin));
        EXPECT_NEAR(static_cast<float>(step.level) + step.blend, std::min(std::log2(diameter), 7.0f), 1e-3f);
        begin += 0.5f * diameter;
    }
    EXPECT_GT(schedule.steps.size(), make_schedule({.half_angle = half_angle, .first_diameter = 0.75f}, pyramid).steps.size());
}

TEST(ConeSchedules, GrowingStepsReachTwoDiametersAndNoMore) {
    const Pyramid pyramid = uniform_pyramid(10, vec4(0));
    const float half_angle = 0.01f;
    const auto steps = make_schedule({.half_angle = half_angle, .first_diameter = 1.0f, .step_growth = 1.1f}, pyramid).steps;
    float begin = 0, ratio = 0.5f;
    for (const auto& step : steps) {
        const float diameter = 1.0f + 2.0f * std::tan(half_angle) * begin;
        EXPECT_NEAR(step.distance, begin + 0.5f * ratio * diameter, 1e-3f * (1 + begin));
        begin += ratio * diameter;
        ratio = std::min(ratio * 1.1f, 2.0f);
    }
    EXPECT_EQ(ratio, 2.0f);
}

TEST(ConeSchedules, LevelsFollowTheDiameter) {
    const Pyramid pyramid = uniform_pyramid(8, vec4(0));
    const float half_angle = 0.4f;
    for (const auto& step : make_schedule({half_angle, 0.75f, 0.5f, 0.0f, 1.0f}, pyramid).steps) {
        // A step takes the diameter d with which it begins, half a step (of .5 d) before its sample: d = .75 + 2 tan(a) (s - .25
        // d).
        const float slope = 2.0f * std::tan(half_angle), diameter = (0.75f + slope * step.distance) / (1.0f + 0.25f * slope);
        const float level = static_cast<float>(step.level) + step.blend;
        if (level <= 0.0f || level >= 7.0f) continue;
        EXPECT_NEAR(level, std::log2(diameter), 1e-3f);
    }
}

TEST(AirMaps, NameExactlyTheTapsThatReadOneOfEightTexels) {
    Pyramid pyramid = uniform_pyramid(8, vec4(0));  // 64 texels a row on the second level: two words and a bit
    Rng rng(3, 1);
    for (auto& level : pyramid.levels)
        for (int i = 0; i < 40; ++i) {
            const ivec3 at =
                glm::min(ivec3(vec3(rng.uniform(), rng.uniform(), rng.uniform()) * vec3(level.size)), level.size - 1);
            const int x = i < 8 ? (i % 2 == 0 ? 31 : 32) % level.size.x : at.x;  // beside the border of two words
            level.texels[4 * level.index(x, at.y, at.z) + 3] = glm::packHalf1x16(0.5f);
        }
    const AirMap air(pyramid);
    for (int number = AirMap::first_level; number <= AirMap::last_level; ++number) {
        const auto& level = pyramid.levels[static_cast<std::size_t>(number)];
        const AirMap::Level& map = *air.of(number);
        const auto solid = [&](const ivec3& at) {
            const ivec3 inner = glm::clamp(at, ivec3(0), level.size - 1);
            return level.texels[4 * level.index(inner.x, inner.y, inner.z) + 3] != 0;
        };
        for (int z = -1; z < level.size.z; ++z)
            for (int y = -1; y < level.size.y; ++y)
                for (int x = -1; x < level.size.x; ++x) {
                    bool any = false;
                    for (int i = 0; i < 8; ++i) any = any || solid({x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)});
                    const auto tap = static_cast<std::uint32_t>(x + 1);
                    const std::size_t word = (tap >> 5) + map.row_words * static_cast<std::size_t>(y + 1) +
                                             map.slice_words * static_cast<std::size_t>(z + 1);
                    // Over the border at x = -1 both texels are the first; there a map may name too many.
                    if (x < 0) continue;
                    ASSERT_EQ((map.words[word] >> (tap & 31) & 1) != 0, any) << number << ": " << x << " " << y << " " << z;
                }
    }
}

TEST(Cones, SeeAUniformWorldAsItIs) {
    for (const int faces : {1, 6}) {
        const Pyramid pyramid = uniform_pyramid(6, {0.25f, 1.5f, 40.0f, 1.0f}, faces);
        ConeBatch batch = random_cones(pyramid, 100);
        march_cones(pyramid, AirMap(pyramid), make_schedule({0.5f, 0.75f, 0.5f, 0.0f, 1.0f}, pyramid), 0.02f, batch);
        for (int i = 0; i < batch.count; ++i) {
            EXPECT_NEAR(batch.r[i], 0.25f, 1e-3f);  // half floats: 5e-4 relative
            EXPECT_NEAR(batch.g[i], 1.5f, 2e-3f);
            EXPECT_NEAR(batch.b[i], 40.0f, 4e-2f);
            EXPECT_EQ(batch.open[i], 0.0f);
        }
    }
}

TEST(Cones, SeeNothingInAnEmptyWorld) {
    const Pyramid pyramid = uniform_pyramid(6, vec4(0));
    ConeBatch batch = random_cones(pyramid, 37);
    march_cones(pyramid, AirMap(pyramid), make_schedule({0.3f, 0.75f, 0.5f, -1.0f, 1.0f}, pyramid), 0.02f, batch);
    for (int i = 0; i < batch.count; ++i) {
        EXPECT_EQ(batch.r[i], 0.0f);
        EXPECT_EQ(batch.open[i], 1.0f);
    }
}

TEST(Cones, FogBlocksByItsDepthWhateverTheStep) {
    // Opacity a of a voxel is depth -ln(1 - a) a voxel: along x from the middle of a 64-voxel box, 32 voxels (and the filter's
    // reach).
    const float a = 0.02f;
    const Pyramid pyramid = uniform_pyramid(7, {0, 0, 0, a});
    for (const float step : {0.25f, 0.5f, 1.0f}) {
        ConeBatch batch{};
        batch.count = 1;
        set_start(batch, 0, pyramid.domain, {32, 32, 32}, {0, 0, 1}, 0.0f, true);
        set_direction(batch, 0, {1, 0, 0});
        march_cones(pyramid, AirMap(pyramid), make_schedule({0.0f, 1.0f, step, 0.0f, 1.0f}, pyramid), 0.0f, batch);
        EXPECT_NEAR(std::log(batch.open[0]) / std::log(1.0f - a), 33.0f, 1.0f) << step;
    }
}

TEST(Cones, WithoutOpacityCorrectionBlendOneTexelAStep) {
    // The papers': each step blocks the fog's a of a texel, however short it is.
    const float a = 0.02f;
    const Pyramid pyramid = uniform_pyramid(7, {0, 0, 0, a});
    for (const float step : {0.5f, 1.0f}) {
        ConeBatch batch{};
        batch.count = 1;
        set_start(batch, 0, pyramid.domain, {32, 32, 32}, {0, 0, 1}, 0.0f, true);
        set_direction(batch, 0, {1, 0, 0});
        const ConeShape shape{.first_diameter = 1.0f, .step = step, .most_steps = 20, .opacity_correction = false};
        march_cones(pyramid, AirMap(pyramid), make_schedule(shape, pyramid), 0.0f, batch);
        EXPECT_NEAR(std::log(batch.open[0]) / std::log(1.0f - a), 20.0f, 0.1f) << step;
    }
}

TEST(Cones, AlongTheFaceOfASolidAreHalfBlockedIfStepsAreCorrelated) {
    Pyramid pyramid = uniform_pyramid(6, vec4(0));
    for (auto& level : pyramid.levels)
        for (std::size_t t = 3; t < level.texels.size(); t += 4) {
            const int x = static_cast<int>(t / 4 % level.row()) - 1;
            level.texels[t] = glm::packHalf1x16(level.size.x == 1 ? 0.5f : x < level.size.x / 2 ? 1.0f : 0.0f);
        }
    const auto left_open = [&](float correlation) {
        ConeBatch batch{};
        batch.count = 1;
        set_start(batch, 0, pyramid.domain, {16, 1, 16}, {0, 1, 0}, 0.0f, true);
        set_direction(batch, 0, {0, 1, 0});
        march_cones(pyramid, AirMap(pyramid), make_schedule({0.2f, 4.0f, 1.0f, 0.0f, 1.0f, correlation}, pyramid), 0.0f, batch);
        return batch.open[0];
    };
    EXPECT_NEAR(left_open(1.0f), 0.5f, 1e-3f);
    EXPECT_LT(left_open(0.5f), 0.4f);
    EXPECT_LT(left_open(0.0f), 0.05f);
}

/// A lobe as it is seen along the normal.
LobeCone from_above(Lobe lobe, float alpha) {
    GBuffer g;
    g.lobe = lobe;
    Scene scene;
    scene.materials.resize(1);
    scene.materials[0].specular = vec3(1);
    Reflections one{};
    one.count = 1;
    one.normal[2][0] = 1.0f;
    one.alpha[0] = alpha;
    find_lobes(LobeTables(g, scene), {0, 0, 1}, false, one);
    return {one.scale[0], one.bias[0], {0, 1}, one.half_angle[0]};
}

TEST(LobeTables, HoldTheAlbedosOfTheClosedForms) {
    // GROUND_TRUTH.md: GGX at normal view with F = 1; tolerance: 256 samples an entry and interpolation in between.
    const float expected[][2] = {{0.1f, 0.9884f}, {0.25f, 0.9158f}, {0.5f, 0.688f}, {1.0f, 1.0f - std::log(2.0f)}};
    for (const auto& [alpha, albedo] : expected) EXPECT_NEAR(from_above(Lobe::ggx, alpha).scale, albedo, 0.006f) << alpha;
    for (const float alpha : {0.05f, 0.2f, 0.6f}) {
        EXPECT_NEAR(from_above(Lobe::phong, alpha).scale, 1.0f, 0.01f) << alpha;
        EXPECT_NEAR(from_above(Lobe::blinn_phong, alpha).scale, 1.0f, 0.02f) << alpha;
    }
}

TEST(LobeTables, ConesOfPhongLobesFollowFromTheExponent) {
    for (const float n : {5.0f, 50.0f, 500.0f}) {
        const LobeCone cone = from_above(Lobe::phong, std::sqrt(2.0f / (n + 2.0f)));
        // Weighted by the cosine to the normal too, which at normal view raises the exponent by one.
        EXPECT_NEAR(std::cos(cone.half_angle), (n + 1.0f) / (n + 3.0f), 0.01f) << n;
    }
}

TEST(LobeTables, LobesSeenAlongTheNormalLieAboutIt) {
    const auto entries = lobe_table(Lobe::phong).entries();
    for (int width = 1; width <= LobeTable::widths / 2; ++width)
        EXPECT_NEAR(entries[width * LobeTable::views - 1].direction.y, 1.0f, 1e-3f) << width;
}

/// A G-buffer of a plane facing the camera, the right half further away by `step`.
GBuffer plane(int width, int height, float step) {
    GBuffer g;
    g.width = width, g.height = height;
    g.position = Buffer<vec3>(g.pixels());
    g.normal = Buffer<vec3>(g.pixels(), vec3(0, 0, 1));
    g.geometric_normal = Buffer<vec3>(g.pixels(), vec3(0, 0, 1));
    g.triangle = Buffer<std::uint32_t>(g.pixels(), 0U);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            g.position[y * width + x] = {0.01f * static_cast<float>(x), 0.01f * static_cast<float>(y),
                                         x < width / 2 ? -1.0f : -1.0f - step};
    return g;
}

struct Halves {
    float left, right;
};
/// Merges pixels that each hold their phase's share of `left` or `right`.
Buffer<vec4> merged(const GBuffer& g, const Interleaved& share, const std::vector<float>& weights, const Halves& value) {
    Buffer<vec4> partial(g.pixels());
    for (int y = 0; y < g.height; ++y)
        for (int x = 0; x < g.width; ++x)
            partial[y * g.width + x] = vec4((x < g.width / 2 ? value.left : value.right) * weights[block_of(share).phase(x, y)]);
    Buffer<vec4> merged(g.pixels());
    merge(share, g, weights, partial, [&](std::size_t first, std::span<const vec4> values) {
        std::copy(values.begin(), values.end(), merged.begin() + first);
    });
    return merged;
}

TEST(Interleaved, KeepsAUniformFieldOfAnyBlockAndBleedsOverNoEdge) {
    for (const int width : {1, 2, 3, 4, 8})
        for (const int height : {1, 2, 5}) {
            const Interleaved share{.width = width, .height = height};
            std::vector<float> weights(width * height);
            for (std::size_t i = 0; i < weights.size(); ++i)
                weights[i] = static_cast<float>(2 * (i + 1)) / static_cast<float>(weights.size() * (weights.size() + 1));
            const GBuffer g = plane(70, 37, 0.5f);
            const auto picture = merged(g, share, weights, {3.0f, 7.0f});
            for (int y = 0; y < g.height; ++y)
                for (int x = 0; x < g.width; ++x)
                    ASSERT_NEAR(picture[y * g.width + x].x, x < g.width / 2 ? 3.0f : 7.0f, 1e-5f)
                        << width << " " << height << " " << x << " " << y;
        }
}

TEST(Interleaved, LeavesPixelsThatHitNothingEmpty) {
    GBuffer g = plane(16, 16, 0.0f);
    g.triangle[5] = no_hit;
    EXPECT_EQ(merged(g, {}, {0.25f, 0.25f, 0.25f, 0.25f}, {1, 1})[5], vec4(0));
}

}  // namespace
}  // namespace interreflect
