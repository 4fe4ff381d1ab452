/// Half floats that kernels write: the nearest ones, ties to even, on every vector target.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "caches/fill/texels.h"
#include "math/half.h"
#include "math/rng.h"

namespace interreflect {
namespace {

/// The nearest half float: halves from 2^e to 2^(e + 1) are 2^(e - 10) apart, and those below 2^-14 are 2^-24.
float nearest(float value) {
    const float apart = std::ldexp(1.0f, std::max(std::ilogb(value), -14) - 10);
    return std::min(std::nearbyint(value / apart) * apart, largest_half);
}

TEST(HalfLanes, AreTheNearestOnesTiesToEven) {
    constexpr std::size_t count = 4096;
    std::vector<float> given(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const float size = std::exp2(32.0f * unit_float(hash32(2 * i)) - 17.0f);
        // Every fourth lies in the middle between two halves, or is one: a tie.
        given[i] = std::copysign(
            i % 4 == 0 ? std::ldexp(std::nearbyint(std::ldexp(size, 11 - std::ilogb(size))), std::ilogb(size) - 11) : size,
            unit_float(hash32(2 * i + 1)) - 0.5f);
    }
    given[1] = 0.0f, given[2] = -0.0f, given[3] = std::ldexp(1.0f, -25), given[5] = std::ldexp(3.0f, -25), given[6] = 1e9f;
    std::vector<std::uint16_t> texels(4 * count);
    pack_texels(given.data(), given.data(), given.data(), given.data(), count, texels.data());
    for (std::size_t i = 0; i < count; ++i) {
        const float made = from_half(texels[4 * i]);
        EXPECT_EQ(made, nearest(given[i])) << given[i];
        EXPECT_EQ(std::signbit(made), std::signbit(given[i])) << given[i];
    }
}

}  // namespace
}  // namespace interreflect
