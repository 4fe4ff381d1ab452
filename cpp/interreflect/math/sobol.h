/// Owen-scrambled Sobol points: any power of two of them is stratified in both dimensions, and each is uniform on its own.
#pragma once
#include "math/rng.h"
#include "math/vectors.h"

namespace interreflect {

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x << 16) | (x >> 16);
    x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
    x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
    x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
    return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

/// Nested uniform scrambling of the bits of x, most significant first, by a hash [Laine and Karras 2011; Burley 2020].
inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t key) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeaU;
    x += key;
    x *= (key >> 16) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return reverse_bits(x);
}

/// Point `index` of the sequence that `key` names, in [0, 1)^2.
inline vec2 sobol_point(std::uint32_t index, std::uint32_t key) {
    const std::uint32_t i = owen_scramble(index, hash_combine(key, 0x51633e2dU));
    std::uint32_t second = 0;
    for (std::uint32_t bits = i, column = 1U << 31; bits != 0; bits >>= 1, column ^= column >> 1)
        if ((bits & 1U) != 0) second ^= column;
    return {unit_float(owen_scramble(reverse_bits(i), hash_combine(key, 1))),
            unit_float(owen_scramble(second, hash_combine(key, 2)))};
}

}  // namespace interreflect
