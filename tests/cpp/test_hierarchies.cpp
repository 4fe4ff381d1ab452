#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "voxels/march/hit_order.h"
#include "voxels/move_voxels.h"

namespace interreflect {
namespace {

struct SeenHit {
    vec3 radiance;
    float open, depth;
};

constexpr int most = 4;
const std::array<SeenHit, most> hits{
    {{{0.6f, 0, 0}, 0.4f, 1.0f}, {{0, 0.5f, 0}, 0.5f, 2.0f}, {{0, 0, 0.7f}, 0.3f, 3.0f}, {{0.2f, 0.2f, 0}, 0.1f, 4.0f}}};

/// Front to back, all of them.
vec3 blended(int count) {
    vec3 radiance(0);
    float open = 1.0f;
    for (int i = 0; i < count; ++i)
        radiance += open * hits[static_cast<std::size_t>(i)].radiance, open *= hits[static_cast<std::size_t>(i)].open;
    return radiance;
}

TEST(HitOrder, UpToThreeHitsAreBlendedFrontToBackInWhateverOrderTheyAreFound) {
    for (int count = 1; count <= 3; ++count) {
        std::array<int, 3> order{0, 1, 2};
        do {
            HitOrder seen;
            for (int i = 0; i < count; ++i) {
                const int which = order[static_cast<std::size_t>(i)];
                if (which >= count) continue;
                const SeenHit& hit = hits[static_cast<std::size_t>(which)];
                seen.add(hit.radiance, hit.open, hit.depth);
            }
            if (std::any_of(order.begin(), order.begin() + count, [&](int i) { return i >= count; })) continue;
            const vec3 wrong = seen.radiance() - blended(count);
            EXPECT_LT(glm::length(wrong), 1e-6f);
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

TEST(HitOrder, OpennessIsTheProductInAnyOrderAndFourHitsKeepTheNearestTwoInFront) {
    std::array<int, most> order{0, 1, 2, 3};
    const vec3 two = blended(2);
    float left = 1.0f, product = 1.0f;
    for (int i = 0; i < most; ++i) product *= hits[static_cast<std::size_t>(i)].open;
    for (int i = 0; i < 2; ++i) left *= hits[static_cast<std::size_t>(i)].open;
    const vec3 ahead = hits[2].radiance + hits[2].open * hits[3].radiance,
               swapped = hits[3].radiance + hits[3].open * hits[2].radiance;
    do {
        HitOrder seen;
        for (const int i : order) {
            const SeenHit& hit = hits[static_cast<std::size_t>(i)];
            seen.add(hit.radiance, hit.open, hit.depth);
        }
        EXPECT_NEAR(seen.open(), product, 1e-6f);
        const vec3 behind = (seen.radiance() - two) / left;
        EXPECT_LT(std::min(glm::length(behind - ahead), glm::length(behind - swapped)), 1e-5f);
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(HitOrder, AHierarchyThatNothingIsSeenInChangesNothing) {
    HitOrder seen;
    seen.add(vec3(0), 1.0f, nothing_there);
    seen.add({1, 2, 3}, 0.25f, 7.0f);
    seen.add(vec3(0), 1.0f, nothing_there);
    EXPECT_EQ(seen.radiance(), vec3(1, 2, 3));
    EXPECT_EQ(seen.open(), 0.25f);
}

TEST(BodyPose, TheWorldAndTheBodyAreEachOthersInverse) {
    const float s = std::sqrt(0.5f);
    const BodyPose pose{3, mat3(s, s, 0, -s, s, 0, 0, 0, 1), {1, 2, 3}};
    const vec3 p(0.3f, -4, 5);
    EXPECT_LT(glm::length(pose.to_body(pose.to_world(p)) - p), 1e-5f);
    EXPECT_LT(glm::length(pose.to_world({1, 0, 0}) - vec3(1 + s, 2 + s, 3)), 1e-6f);
    EXPECT_LT(glm::length(pose.direction_to_body(pose.direction_to_world(p)) - p), 1e-5f);
}

}  // namespace
}  // namespace interreflect
