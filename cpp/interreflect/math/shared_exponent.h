/// Three numbers in 32 bits: nine bits each, and five of one exponent (RGB9E5).
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "math/vectors.h"

namespace interreflect {

/// The largest that a number may be: 511 2^7.
inline constexpr float most_shared_exponent = 65408.0f;

/// Rounds to nearest, by at most a 512th of the largest of the three (below 2^-15 by 2^-25). v: not negative, at most
/// most_shared_exponent.
inline std::uint32_t to_shared_exponent(const vec3& v) {
    const float largest = max_component(v);
    // The exponent of a float is its bits 23 to 30; the largest must lie below 2^(e - 15).
    const auto exponent_of = [](float f) { return static_cast<int>(std::bit_cast<std::uint32_t>(f) >> 23) - 126; };
    int e = std::max(exponent_of(largest), -15);
    const auto scale = [](int of) { return std::bit_cast<float>(static_cast<std::uint32_t>(9 - of + 127) << 23); };
    if (largest * scale(e) >= 511.5f) ++e;
    const vec3 m = v * scale(e) + 0.5f;
    return static_cast<std::uint32_t>(m.x) | static_cast<std::uint32_t>(m.y) << 9 | static_cast<std::uint32_t>(m.z) << 18 |
           static_cast<std::uint32_t>(e + 15) << 27;
}

inline vec3 from_shared_exponent(std::uint32_t bits) {
    const float scale = std::bit_cast<float>(((bits >> 27) + 127 - 24) << 23);
    return vec3(static_cast<float>(bits & 511), static_cast<float>(bits >> 9 & 511), static_cast<float>(bits >> 18 & 511)) *
           scale;
}

}  // namespace interreflect
