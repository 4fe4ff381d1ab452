/// Stratified points of one pixel: a (0, 2)-sequence and a third, independent coordinate, each moved by the pixel's own key.
#pragma once
#include "math/rng.h"
#include "math/vectors.h"

namespace interreflect {

/// Any 2^k consecutive points from the first on fall into 2^k different cells, however the unit square is cut into 2^k equal
/// boxes; scrambling by exclusive or keeps that and makes every point uniform [Kollig and Keller 2002].
class StratifiedPoints {
  public:
    StratifiedPoints(std::uint32_t seed, std::uint32_t index, std::uint32_t purpose)
        : key_(hash_combine(hash_combine(seed, index), purpose)),
          scramble_x_(hash32(key_ ^ 0x68bc21ebU)),
          scramble_y_(hash32(key_ ^ 0x02e5be93U)),
          turn_(unit_float(hash32(key_ ^ 0x967a889bU))) {}

    vec2 point(std::uint32_t i) const { return {unit_float(reversed(i) ^ scramble_x_), unit_float(sobol(i) ^ scramble_y_)}; }
    /// Multiples of the golden ratio, turned: evenly spread for any number of points.
    float choice(std::uint32_t i) const {
        const float x = turn_ + unit_float(i * 0x9e3779b9U);
        return x < 1.0f ? x : x - 1.0f;
    }

  private:
    static std::uint32_t reversed(std::uint32_t bits) {
        bits = (bits << 16) | (bits >> 16);
        bits = ((bits & 0x00ff00ffU) << 8) | ((bits & 0xff00ff00U) >> 8);
        bits = ((bits & 0x0f0f0f0fU) << 4) | ((bits & 0xf0f0f0f0U) >> 4);
        bits = ((bits & 0x33333333U) << 2) | ((bits & 0xccccccccU) >> 2);
        return ((bits & 0x55555555U) << 1) | ((bits & 0xaaaaaaaaU) >> 1);
    }
    /// Sobol's second dimension.
    static std::uint32_t sobol(std::uint32_t i) {
        std::uint32_t result = 0;
        for (std::uint32_t v = 1U << 31; i != 0; i >>= 1, v ^= v >> 1)
            if ((i & 1U) != 0) result ^= v;
        return result;
    }

    std::uint32_t key_, scramble_x_, scramble_y_;
    float turn_;
};

}  // namespace interreflect
