/// Work counts: they compare across machines where milliseconds do not.
#pragma once
#include <cstdint>

namespace interreflect {

struct Counts {
    std::uint64_t rays = 0;               // nearest-hit rays
    std::uint64_t shadow_rays = 0;        // any-hit rays
    std::uint64_t paths = 0;              // camera paths
    std::uint64_t samples = 0;            // surface samples taken to voxelize
    std::uint64_t voxels = 0;             // voxels written
    std::uint64_t cones = 0;              // cones marched
    std::uint64_t cone_steps = 0;         // steps of all cones
    std::uint64_t voxel_fetches = 0;      // filtered look-ups of the voxel pyramid
    std::uint64_t clusters = 0;           // of pixels
    std::uint64_t caches = 0;             // placed or filled
    std::uint64_t reused_caches = 0;      // of those, kept from the last frame
    std::uint64_t cache_evaluations = 0;  // of a cache for a pixel, with a weight above 0
    std::uint64_t covered_pixels = 0;     // whose caches' weights sum up to more than 0
    std::uint64_t uncovered_pixels = 0;   // the other ones that see a surface

    Counts& operator+=(const Counts& other) {
        rays += other.rays;
        shadow_rays += other.shadow_rays;
        paths += other.paths;
        samples += other.samples;
        voxels += other.voxels;
        cones += other.cones;
        cone_steps += other.cone_steps;
        voxel_fetches += other.voxel_fetches;
        clusters += other.clusters;
        caches += other.caches;
        reused_caches += other.reused_caches;
        cache_evaluations += other.cache_evaluations;
        covered_pixels += other.covered_pixels;
        uncovered_pixels += other.uncovered_pixels;
        return *this;
    }
};

}  // namespace interreflect
