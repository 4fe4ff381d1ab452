/// Light that pixels get from caches.
#pragma once
#include "data/caches.h"
#include "data/gathered_light.h"
#include "data/gbuffer.h"

namespace interreflect {

struct CacheLight {
    GatheredLight gathered;  // what arrives about the shading normal
    GlossyLight glossy;      // what the glossy lobe reflects towards the camera
    Buffer<float> weight;    // sum of the caches' weights, of each pixel; 0 where no cache serves it
    Counts counts;

    std::size_t bytes() const { return gathered.bytes() + glossy.bytes() + weight.bytes(); }
};

/// Weighted sums of what caches hold for one pixel, in their unit.
struct CacheSum {
    vec4 diffuse{0}, glossy{0};          // mean radiance over the lobe, and how open it is
    vec3 diffuse_sky{0}, glossy_sky{0};  // mean radiance of an environment image over it
    float weight = 0;

    void add(const CacheSum& one, float by) {
        diffuse += one.diffuse * by, glossy += one.glossy * by;
        diffuse_sky += one.diffuse_sky * by, glossy_sky += one.glossy_sky * by;
        weight += by;
    }
};

/// Not yet written.
CacheLight empty_cache_light(const GBuffer& gbuffer);

}  // namespace interreflect
