/// Half floats for storage.
#pragma once
#include <cstdint>
#include <glm/gtc/packing.hpp>

namespace interreflect {

/// Rounds to nearest; what is too large becomes infinite.
inline std::uint16_t to_half(float value) { return glm::packHalf1x16(value); }
inline float from_half(std::uint16_t bits) { return glm::unpackHalf1x16(bits); }

}  // namespace interreflect
