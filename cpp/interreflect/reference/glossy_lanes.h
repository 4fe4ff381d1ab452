/// Lanes with a glossy lobe, one by one: between the vector kernels and brdf.h.
#pragma once
#include <span>

#include "reference/path_lanes.h"

namespace interreflect {

/// Directions, values and densities of the lanes of one vector.
struct alignas(64) GlossyLanes {
    using Lanes = RayPacket::Lanes;
    Lanes direction[3], value[3], pdf;  // value: of the BRDF, or the weight of a sample

    vec3 at(int lane) const { return {direction[0][lane], direction[1][lane], direction[2][lane]}; }
    void set_value(int lane, const vec3& v) { value[0][lane] = v.x, value[1][lane] = v.y, value[2][lane] = v.z; }
};

/// BRDF and density for the directions of those lanes of paths [first, first + 16) that have a lobe.
void evaluate_glossy(const PathLanes& paths, std::span<const Material> materials, std::uint32_t first, int lanes, GlossyLanes& g);
/// Sampled directions with weight and density; `choose`, `u`, `v`: random numbers by lane.
void sample_glossy(const PathLanes& paths, std::span<const Material> materials, std::uint32_t first, int lanes,
                   const float* choose, const float* u, const float* v, GlossyLanes& g);

}  // namespace interreflect
