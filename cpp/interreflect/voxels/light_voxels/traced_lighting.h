#pragma once
#include <cstdint>
#include <memory>

#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "visibility/intersector.h"

namespace interreflect {

/// A shadow ray against the triangles to every delta light, and stratified samples of emitters and environment.
struct TracedLighting {
    int samples = 4;

    bool operator==(const TracedLighting&) const = default;
    static constexpr auto description = describe(
        "TracedLighting",
        "A shadow ray against the triangles to every delta light, and stratified samples of emitters and environment.",
        Source{"Rehfeld et al. 2014", "3.1, with traced shadows"},
        Param{"samples", &TracedLighting::samples, "samples of the emitters and of the environment, each, a voxel and side",
              Unit::samples, between(1, 4096)});
};

LitVoxels light_voxels(const TracedLighting& technique, const Scene& scene, const Intersector& intersector,
                       std::shared_ptr<const VoxelGrid> voxels, std::uint32_t seed);

}  // namespace interreflect
