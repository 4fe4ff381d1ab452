#include <gtest/gtest.h>

#include <vector>

#include "math/hemisphere_map.h"
#include "math/rng.h"

namespace interreflect {
namespace {

vec2 random_point(Rng& rng) {
    const float x = rng.uniform();
    return {x, rng.uniform()};
}

TEST(HemisphereMap, IsUndoneByItsInverse) {
    Rng rng(3, 1);
    for (int i = 0; i < 100000; ++i) {
        const vec2 point = random_point(rng);
        const vec3 direction = hemisphere_direction(point);
        ASSERT_NEAR(glm::length(direction), 1.0f, 1e-6f);
        ASSERT_GE(direction.z, 0.0f);
        // Near the centre z = 1 - r^2 keeps r to sqrt(2^-24) only.
        const float radius = std::sqrt(std::max(1.0f - direction.z, 0.0f));
        const float tolerance = 1e-6f + 1e-7f / std::max(radius, 1e-3f);
        const vec2 back = hemisphere_square(direction);
        ASSERT_NEAR(back.x, point.x, tolerance);
        ASSERT_NEAR(back.y, point.y, tolerance);
    }
}

TEST(HemisphereMap, GivesEveryTexelItsSolidAngle) {
    constexpr int resolution = 7, samples = 490000;  // 10,000 a texel: a standard deviation of 1 %
    std::vector<int> found(resolution * resolution);
    Rng rng(5, 1);
    for (int i = 0; i < samples; ++i) {
        vec3 direction = uniform_sphere(random_point(rng));
        direction.z = std::fabs(direction.z);
        const vec2 at = hemisphere_square(direction) * static_cast<float>(resolution);
        ++found[static_cast<std::size_t>(std::min(static_cast<int>(at.y), resolution - 1) * resolution +
                                         std::min(static_cast<int>(at.x), resolution - 1))];
    }
    EXPECT_NEAR(map_texel_solid_angle(resolution) * resolution * resolution, 2.0f * pi, 1e-5f);
    for (const int count : found) EXPECT_NEAR(count, samples / (resolution * resolution), 450);  // 4.5 standard deviations
}

TEST(HemisphereMap, IsContinuousAcrossItsDiagonalsAndUpToItsRim) {
    Rng rng(7, 1);
    constexpr float step = 1e-4f;
    for (int i = 0; i < 20000; ++i) {
        const float along = rng.uniform(), angle = 2.0f * pi * rng.uniform();
        const vec2 turn(std::cos(angle), std::sin(angle));
        for (const vec2& at : {vec2(along, along), vec2(along, 1.0f - along), vec2(along, 1.0f - step), vec2(0.5f, along)}) {
            const vec2 near = glm::clamp(at + turn * step, 0.0f, 1.0f);
            // A square of side e is mapped to an area of 2 pi e^2: steps grow about 2.5 times, up to 4.2 in a corner; a jump
            // would be far longer than five steps.
            ASSERT_LT(glm::length(hemisphere_direction(at) - hemisphere_direction(near)), 5.0f * step);
        }
    }
}

TEST(HemisphereMap, TakesDirectionsBelowTheHorizonToTheRimAboveThem) {
    Rng rng(9, 1);
    for (int i = 0; i < 1000; ++i) {
        const vec3 up = uniform_sphere(random_point(rng));
        const vec3 down(up.x, up.y, -std::fabs(up.z));
        const vec2 at = hemisphere_square(down);
        const float rim = std::max(std::fabs(at.x - 0.5f), std::fabs(at.y - 0.5f));
        ASSERT_NEAR(rim, 0.5f, 1e-6f);
        const vec3 there = hemisphere_direction(at);
        ASSERT_NEAR(glm::dot(glm::normalize(vec2(down)), glm::normalize(vec2(there))), 1.0f, 1e-5f);
    }
    EXPECT_EQ(hemisphere_square({0, 0, 1}), vec2(0.5f));
    EXPECT_EQ(hemisphere_square({0, 0, -1}), vec2(1.0f));
}

}  // namespace
}  // namespace interreflect
