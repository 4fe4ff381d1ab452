/// Halton's sequence: digits mirrored at the point [Halton 1964].
#pragma once
#include <cstdint>

namespace interreflect {

/// In [0, 1).
inline float radical_inverse(std::uint32_t base, std::uint32_t index) {
    double sum = 0, digit = 1.0 / base;
    for (; index > 0; index /= base, digit /= base) sum += digit * (index % base);
    const auto value = static_cast<float>(sum);
    return value < 1.0f ? value : 0x1.fffffep-1f;
}

}  // namespace interreflect
