/// The inner loop of trace_gbuffer: packets of 4 x 4 pixels, shaded as wide as the machine's vectors.
#pragma once
#include <vector>

#include "data/gbuffer.h"
#include "data/scene.h"
#include "math/parallel.h"
#include "visibility/intersector.h"
#include "visibility/kernel_material.h"

namespace interreflect {

/// Everything that all tiles of one picture share.
struct GBufferJob {
    const Scene& scene;
    const Intersector& intersector;
    const CameraRays& rays;
    GBuffer& g;
    float pixel_area;  // of a pixel at distance 1 along the view
    std::vector<KernelMaterial> materials;
};

/// Traces and shades one tile, whose corner lies on a multiple of 4 pixels.
void trace_gbuffer_tile(const GBufferJob& job, const Tile& tile);

/// One pixel by itself: what the kernel leaves out (emission, float textures, instances that moved) and what misses.
void store_gbuffer_pixel(const GBufferJob& job, int x, int y, const Hit& hit);

}  // namespace interreflect
