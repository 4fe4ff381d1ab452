/// The random numbers of one tile of a picture.
///
/// Pixel pattern k takes at sample s the point a(s) xor b(k): `a` is a scrambled sequence of its own, so every pixel's samples
/// are stratified, and `b` another, so at every sample the patterns are stratified over the tile. Seen alone each point is
/// uniform, whatever is shared. Keyed by (seed, tile, dimension) only.
#pragma once
#include "math/owen_sobol.h"
#include "math/vectors.h"

namespace interreflect {

class SampleSequence {
  public:
    SampleSequence(std::uint32_t seed, std::uint32_t tile) : key_(hash_combine(hash32(seed), tile)) {}

    /// Pairs number `dimension` of sample s, in [0, 1)^2, of patterns 0 .. n - 1.
    void pairs(std::uint32_t dimension, std::uint32_t s, std::uint32_t n, float* x, float* y) const {
        const Bits2 a = owen_sobol(s, hash_combine(key_, 2 * dimension));
        const std::uint32_t key = hash_combine(key_, 2 * dimension + 1);
        for (std::uint32_t k = 0; k < n; ++k) {
            const Bits2 b = owen_sobol(k, key);
            x[k] = unit_float(a.x ^ b.x), y[k] = unit_float(a.y ^ b.y);
        }
    }

  private:
    std::uint32_t key_;
};

}  // namespace interreflect
