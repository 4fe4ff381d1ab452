/// Random numbers that belong to the sample: a stream is keyed by (seed, index, iteration) and owes nothing to what ran before.
#pragma once
#include <cstdint>

namespace interreflect {

/// A well mixed 32-bit hash [Wellons, "lowbias32"].
inline std::uint32_t hash32(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ (x >> 16);
}
inline std::uint32_t hash_combine(std::uint32_t a, std::uint32_t b) {
    return hash32(a ^ (hash32(b) + 0x9e3779b9U + (a << 6) + (a >> 2)));
}

/// [0, 1) from the top 24 bits.
inline float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// PCG-XSH-RR 64/32 [O'Neill 2014], one stream a key.
class Rng {
  public:
    Rng(std::uint32_t seed, std::uint32_t index, std::uint32_t iteration = 0) {
        const std::uint64_t key =
            (static_cast<std::uint64_t>(hash_combine(seed, index)) << 32) | hash_combine(iteration, index + 0x632be5abU);
        increment_ = (key << 1) | 1U;
        next();
        state_ += (static_cast<std::uint64_t>(hash_combine(index, seed)) << 32) | hash32(iteration);
        next();
    }
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005ULL + increment_;
        const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
        const auto turn = static_cast<std::uint32_t>(old >> 59U);
        return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
    }
    /// Uniform in [0, 1).
    float uniform() { return unit_float(next()); }

  private:
    std::uint64_t state_ = 0, increment_ = 1;
};

}  // namespace interreflect
