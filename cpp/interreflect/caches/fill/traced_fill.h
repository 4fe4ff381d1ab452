#pragma once
#include <cstdint>

#include "data/caches.h"
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Rays against the triangles, spread evenly over each texel's solid angle and weighted by their cosines to the cache's normal,
/// so that its irradiance is right at any resolution; what one hits has the radiance of the finest voxel there. With one sample a
/// texel it shows what pre-filtered voxels spare: bright parts that no ray meets.
struct TracedFill {
    int resolution = 16;
    int samples = 16;

    bool operator==(const TracedFill&) const = default;
    static constexpr auto description = describe(
        "TracedFill", "Rays spread over each texel against the triangles, radiance read from the finest voxel at the hit.",
        Source{"Interreflect"},
        Param{"resolution", &TracedFill::resolution, "side of a cache's hemisphere map", Unit::texels, between(1, 128)},
        Param{"samples", &TracedFill::samples, "rays a texel", Unit::samples, between(1, 65536)});
};

FilledCaches fill(const TracedFill& technique, std::shared_ptr<const CachePlaces> places, Pyramids pyramids, const Scene& scene,
                  const Intersector& intersector, std::uint32_t seed);

}  // namespace interreflect
