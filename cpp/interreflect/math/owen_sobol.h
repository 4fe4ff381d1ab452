/// The first two Sobol dimensions, Owen-scrambled by a hash [Laine and Karras 2011; Burley 2020].
#pragma once
#include <cstdint>

#include "math/rng.h"

namespace interreflect {

inline std::uint32_t reverse_bits(std::uint32_t x) {
    x = (x >> 16) | (x << 16);
    x = ((x & 0x00ff00ffU) << 8) | ((x & 0xff00ff00U) >> 8);
    x = ((x & 0x0f0f0f0fU) << 4) | ((x & 0xf0f0f0f0U) >> 4);
    x = ((x & 0x33333333U) << 2) | ((x & 0xccccccccU) >> 2);
    return ((x & 0x55555555U) << 1) | ((x & 0xaaaaaaaaU) >> 1);
}

/// A permutation in which a bit only depends on the bits below it: on reversed bits, Owen's nested uniform scramble.
inline std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526c56U;
    return x ^ (x * 0x53a22864U);
}
inline std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    return reverse_bits(laine_karras(reverse_bits(x), seed));
}

/// The second Sobol dimension, its bits reversed; the first is reverse_bits. Its generator matrix is Pascal's triangle modulo 2:
/// bit i is the sum of the index's bits j of which i is a subset (Lucas), a transform of five steps.
inline std::uint32_t reversed_sobol_second(std::uint32_t x) {
    x ^= x >> 16 & 0x0000ffffU;
    x ^= x >> 8 & 0x00ff00ffU;
    x ^= x >> 4 & 0x0f0f0f0fU;
    x ^= x >> 2 & 0x33333333U;
    return x ^ (x >> 1 & 0x55555555U);
}

struct Bits2 {
    std::uint32_t x, y;
};
/// Point `index` of a scrambled (0, 2)-sequence, its order shuffled, as 32-bit fractions; every key gives an independent one.
inline Bits2 owen_sobol(std::uint32_t index, std::uint32_t key) {
    const std::uint32_t shuffled = owen_scramble(index, hash32(key));
    return {reverse_bits(laine_karras(shuffled, hash32(key ^ 0x9e3779b9U))),
            reverse_bits(laine_karras(reversed_sobol_second(shuffled), hash32(key ^ 0x7f4a7c15U)))};
}

}  // namespace interreflect
