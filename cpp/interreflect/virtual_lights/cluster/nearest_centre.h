/// Which centre is nearest to each of a row of texels?
#pragma once
#include <cstdint>
#include <span>

#include "math/vectors.h"

namespace interreflect {

/// A cluster's centre as the metric compares it with texels.
struct MetricCentre {
    vec3 position, normal, flux;      // flux over the largest of its map
    float first_x = 0, last_x = 0;    // texels of the row that it may win
    int first_row = 0, last_row = 0;  // rows in which it may
    std::uint32_t cluster = 0;
};
struct MetricWeights {
    float position = 0, normal = 0, flux = 0;  // position: over the extent
};
/// Texels of one row.
struct TexelRow {
    const vec3 *position, *normal, *flux;
    int count;
    int row;           // its number
    float flux_scale;  // 1 / the largest flux of the map
};

/// Writes the cluster of the centre with the least distance to every texel, the first of several; no_virtual_light where none may
/// win it, or where it sends nothing on. Returns whether any that sends light on has none.
bool nearest_centres(const TexelRow& row, const MetricWeights& weights, std::span<const MetricCentre> centres,
                     std::uint32_t* nearest);

}  // namespace interreflect
