#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "math/rng.h"
#include "visibility/sphere_hierarchy.h"

namespace interreflect {
namespace {

float random(std::uint32_t i) { return unit_float(hash32(i)); }

TEST(SphereHierarchy, FindsTheSpheresThatReachAPlaceInOrderAndHardlyAnyOther) {
    for (const float scale : {1e-3f, 1.0f, 1e3f}) {
        std::vector<vec3> centres;
        std::vector<float> radii;
        for (std::uint32_t i = 0; i < 3000; ++i) {
            centres.push_back(scale * vec3(random(5 * i), random(5 * i + 1), random(5 * i + 2)));
            radii.push_back(i % 7 == 0 ? 0.0f : scale * 0.1f * random(5 * i + 3));
        }
        const SphereHierarchy hierarchy(centres, radii);
        std::size_t in_reach = 0, found_in_all = 0;
        for (std::uint32_t q = 0; q < 200; ++q) {
            const vec3 point = scale * 1.5f * vec3(random(9 * q + 1), random(9 * q + 2), random(9 * q + 3));
            const float distance = q % 3 == 0 ? 0.0f : scale * 0.2f * random(9 * q + 4);
            std::vector<std::uint32_t> found, expected;
            hierarchy.reach(point, distance, found);
            for (std::uint32_t i = 0; i < centres.size(); ++i)
                if (glm::length(centres[i] - point) <= distance + radii[i]) expected.push_back(i);
            EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
            EXPECT_TRUE(std::includes(found.begin(), found.end(), expected.begin(), expected.end()));
            in_reach += expected.size(), found_in_all += found.size();
        }
        EXPECT_GT(in_reach, 1000u);
        // Only those at the rim, by a hundred-thousandth of the lengths.
        EXPECT_LE(found_in_all, in_reach + in_reach / 1000);
    }
}

TEST(SphereHierarchy, OfNothingNothingReaches) {
    std::vector<std::uint32_t> found{1, 2};
    SphereHierarchy({}, {}).reach(vec3(0), 1.0f, found);
    EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace interreflect
