/// Where the samples of a multisampled pixel lie.
#pragma once
#include <array>
#include <span>

#include "math/vectors.h"

namespace interreflect {

/// The standard positions of 1, 2, 4 or 8 samples in the pixel [0, 1)^2 [Direct3D 11, D3D11_STANDARD_MULTISAMPLE_PATTERN; Vulkan,
/// standardSampleLocations]; empty for other numbers. No two samples of a pattern share a row or a column.
inline std::span<const vec2> sample_pattern(int samples) {
    constexpr auto at = [](int x, int y) { return vec2(static_cast<float>(x + 8) / 16.0f, static_cast<float>(y + 8) / 16.0f); };
    static const std::array<vec2, 1> one{at(0, 0)};
    static const std::array<vec2, 2> two{at(4, 4), at(-4, -4)};
    static const std::array<vec2, 4> four{at(-2, -6), at(6, -2), at(-6, 2), at(2, 6)};
    static const std::array<vec2, 8> eight{at(1, -3), at(-1, 3),  at(5, 1), at(-3, -5),
                                           at(-5, 5), at(-7, -1), at(3, 7), at(7, -7)};
    switch (samples) {
        case 1:
            return one;
        case 2:
            return two;
        case 4:
            return four;
        case 8:
            return eight;
        default:
            return {};
    }
}

}  // namespace interreflect
