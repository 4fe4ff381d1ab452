#pragma once
#include <cstdint>

#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "shading/share.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Rays against the triangles from each pixel; what a ray hits has the radiance of the finest voxel there. An unbiased estimate
/// of the voxels' light: cosine-distributed over the hemisphere (`march`), in proportion to the lobe (`glossy`).
struct TracedRays {
    int samples = 512;
    int tile = 1;

    bool operator==(const TracedRays&) const = default;
    static constexpr auto description = describe(
        "TracedRays", "Rays against the triangles from each pixel, radiance read from the finest voxel at the hit.",
        Source{"Interreflect"}, Param{"samples", &TracedRays::samples, "rays a pixel", Unit::samples, between(1, 65536)},
        Param{"tile", &TracedRays::tile,
              "pixels on a side of the tiles that share their random numbers, which makes rays coherent and errors alike; 1: "
              "every pixel has its own",
              Unit::pixels, between(1, 64)});
};

GatheredLight march(const TracedRays& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene,
                    const Intersector& intersector, const Share& share, std::uint32_t seed);
GlossyLight glossy(const TracedRays& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene,
                   const Intersector& intersector, std::uint32_t seed);

}  // namespace interreflect
