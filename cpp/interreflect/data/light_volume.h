/// Light volumes: the light that passes through the cells of a grid, and the surface that blocks it, in spherical harmonics.
#pragma once
#include "data/buffer.h"
#include "data/counts.h"
#include "data/domain.h"

namespace interreflect {

/// Radiant intensity of every cell, W/sr, as of a point light at its middle: two bands of spherical harmonics for each of red,
/// green and blue, the four coefficients of a colour together, cell by cell as Domain numbers them.
struct LightVolume {
    static constexpr int harmonics = 4, values = 3 * harmonics;

    Domain domain;  // evenly spread, one grid
    Buffer<float> coefficients;
    Counts counts;

    const float* cell(std::size_t number) const { return coefficients.data() + number * values; }
    std::size_t bytes() const { return coefficients.bytes(); }
};

/// How much surface stands at the corners of a grid's cells and which way it looks: the share of the light from a direction that
/// is blocked there, in two bands of spherical harmonics, corner by corner, x fastest.
struct GeometryVolume {
    Domain domain;  // of the cells
    Buffer<float> coefficients;
    Counts counts;

    ivec3 corners() const { return domain.cells + 1; }
    std::size_t bytes() const { return coefficients.bytes(); }
};

}  // namespace interreflect
