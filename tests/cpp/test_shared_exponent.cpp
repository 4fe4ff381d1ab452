/// Three numbers with one exponent: the format as the library of vectors reads it, and what it rounds.
#include <gtest/gtest.h>

#include <glm/gtc/packing.hpp>

#include "math/rng.h"
#include "math/shared_exponent.h"

namespace interreflect {
namespace {

vec3 random_colour(std::uint32_t i) {
    const auto number = [&](std::uint32_t k) { return unit_float(hash32(4 * i + k)); };
    const float scale = std::exp2(31.0f * number(3) - 15.0f);
    return vec3(number(0), number(1), number(2)) * std::min(scale, most_shared_exponent);
}

TEST(SharedExponent, IsReadAsTheLibraryDoes) {
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const std::uint32_t bits = hash32(i);
        const vec3 expected = glm::unpackF3x9_E1x5(bits), found = from_shared_exponent(bits);
        EXPECT_EQ(found, expected);
    }
}

TEST(SharedExponent, RoundsByAtMostA512thOfTheLargest) {
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const vec3 colour = random_colour(i), kept = from_shared_exponent(to_shared_exponent(colour));
        const float most = std::max(max_component(colour) / 512.0f, std::exp2(-25.0f));
        EXPECT_LE(max_component(glm::abs(kept - colour)), most) << i;
    }
}

TEST(SharedExponent, KeepsTheEndsOfItsRange) {
    EXPECT_EQ(to_shared_exponent(vec3(0)), 0u);
    EXPECT_EQ(from_shared_exponent(to_shared_exponent(vec3(most_shared_exponent, 0, 1))).x, most_shared_exponent);
    for (const float value : {1.0f, 0.5f, 511.0f, 511.6f, 1023.4f, std::exp2(-15.0f), std::exp2(-24.0f)}) {
        const float kept = from_shared_exponent(to_shared_exponent(vec3(0, value, 0))).y;
        EXPECT_LE(std::fabs(kept - value), value / 512.0f) << value;
    }
    EXPECT_EQ(from_shared_exponent(to_shared_exponent(vec3(std::exp2(-30.0f)))), vec3(0));
}

}  // namespace
}  // namespace interreflect
