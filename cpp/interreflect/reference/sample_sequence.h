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

    /// Pair number `dimension` of sample s of pattern k, in [0, 1)^2.
    vec2 pair(std::uint32_t dimension, std::uint32_t s, std::uint32_t k) const {
        return join(of_sample(dimension, s), of_pattern(dimension, k));
    }
    Bits2 of_sample(std::uint32_t dimension, std::uint32_t s) const { return owen_sobol(s, hash_combine(key_, 2 * dimension)); }
    Bits2 of_pattern(std::uint32_t dimension, std::uint32_t k) const {
        return owen_sobol(k, hash_combine(key_, 2 * dimension + 1));
    }
    static vec2 join(const Bits2& a, const Bits2& b) { return {unit_float(a.x ^ b.x), unit_float(a.y ^ b.y)}; }

  private:
    std::uint32_t key_;
};

}  // namespace interreflect
