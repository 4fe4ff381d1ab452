/// Work counts: they compare across machines where milliseconds do not.
#pragma once
#include <cstdint>

namespace interreflect {

struct Counts {
    std::uint64_t rays = 0;           // nearest-hit rays
    std::uint64_t shadow_rays = 0;    // any-hit rays
    std::uint64_t paths = 0;          // camera paths
    std::uint64_t samples = 0;        // surface samples taken to voxelize
    std::uint64_t voxels = 0;         // voxels written
    std::uint64_t cones = 0;          // cones marched
    std::uint64_t cone_steps = 0;     // steps of all cones
    std::uint64_t voxel_fetches = 0;  // filtered look-ups of the voxel pyramid

    Counts& operator+=(const Counts& other) {
        rays += other.rays;
        shadow_rays += other.shadow_rays;
        paths += other.paths;
        samples += other.samples;
        voxels += other.voxels;
        cones += other.cones;
        cone_steps += other.cone_steps;
        voxel_fetches += other.voxel_fetches;
        return *this;
    }
};

}  // namespace interreflect
