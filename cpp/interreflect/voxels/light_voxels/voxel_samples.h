/// Where the light samples of a voxel lie in the unit cube.
#pragma once
#include <array>
#include <cstdint>

#include "data/voxel_grid.h"
#include "math/rng.h"

namespace interreflect {

/// A fraction of 2^32: sums wrap around as a Kronecker sequence asks for.
constexpr std::uint32_t fraction(double value) { return static_cast<std::uint32_t>(value * 0x1p32); }

/// Three coordinates of a unit cube, as fractions of 2^32.
using CubePoint = std::array<std::uint32_t, 3>;

/// Where the samples of all voxels begin.
inline CubePoint shift_of(std::uint32_t seed, std::uint32_t purpose) {
    const std::uint32_t key = hash_combine(seed, purpose);
    return {hash_combine(key, 0), hash_combine(key, 1), hash_combine(key, 2)};
}

/// Unit cube samples of a voxel: a Kronecker sequence over its coordinates, so that neighbours look in different directions
/// (they are seen together, by cones), shifted by the seed; over its own samples, a rank-1 sequence again.
struct VoxelSamples {
    CubePoint start;

    VoxelSamples(const ivec3& at, const CubePoint& shift) {
        // Roots of x^(d+1) = x + 1 give the steps [Roberts 2018]; nine for three coordinates by three numbers.
        static constexpr std::uint32_t steps[3][3] = {{fraction(0.8191725134), fraction(0.6710436067), fraction(0.5497004779)},
                                                      {fraction(0.6180339887), fraction(0.7320508076), fraction(0.2360679775)},
                                                      {fraction(0.4142135624), fraction(0.6457513111), fraction(0.8284271247)}};
        const auto x = static_cast<std::uint32_t>(at.x), y = static_cast<std::uint32_t>(at.y),
                   z = static_cast<std::uint32_t>(at.z);
        for (std::size_t k = 0; k < 3; ++k) start[k] = steps[k][0] * x + steps[k][1] * y + steps[k][2] * z + shift[k];
    }
    /// Sample i of n: stratified in x, a low-discrepancy set in all three.
    vec3 at(int i, int n) const {
        const auto k = static_cast<std::uint32_t>(i);
        const auto stratum = static_cast<std::uint32_t>((static_cast<std::uint64_t>(k) << 32) / static_cast<std::uint32_t>(n));
        return {unit_float(start[0] + stratum), unit_float(start[1] + k * fraction(0.7548776662)),
                unit_float(start[2] + k * fraction(0.5698402910))};
    }
};

}  // namespace interreflect
