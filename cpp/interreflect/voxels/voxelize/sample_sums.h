/// Samples of one surface, brought into cells many at a time.
#pragma once
#include <array>
#include <cstdint>

#include "data/warp.h"

namespace interreflect {

/// What samples are worth to their cells: as in Contribution.
struct SampleSums {
    static constexpr int most = 128;
    static constexpr std::uint32_t outside = 0xffffffffU;  // the cell of samples that fall into none
    static constexpr int spare = 16;                       // a vector may reach beyond the last one

    alignas(64) std::array<std::uint32_t, most + spare> cell;
    alignas(64) std::array<std::array<float, 4>, most + spare> albedo, position;
};

/// A triangle as the samples with barycentric weights (a, b) of its second and third corner see it: everything is the first
/// corner's value + a times the first + b times the second edge's.
struct SampledSurface {
    vec3 corner, edge[2];                 // voxels
    vec2 texcoord, texcoord_edge[2];      // where texels are looked up
    vec3 albedo;                          // of the material
    const std::uint32_t* srgb = nullptr;  // texels of the chosen mip level; null: uniform
    int width = 1, height = 1;
    ivec3 cells;
};

/// Weights and areas of samples; readable up to `spare` beyond the last one.
struct SampleWeights {
    const float *second, *third, *area;
    float scale;  // of the areas
};

/// At most SampleSums::most samples.
void sum_samples(const SampledSurface& surface, const SampleWeights& weights, int count, SampleSums& sums);

}  // namespace interreflect
