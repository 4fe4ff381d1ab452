/// What pixels get from caches of surfels' light.
#pragma once
#include "data/gathered_light.h"
#include "data/gbuffer.h"

namespace interreflect {

struct SurfelLight {
    GatheredLight gathered;  // irradiance alone
    GlossyLight glossy;      // radiance alone
    Counts counts;

    std::size_t bytes() const { return gathered.bytes() + glossy.bytes(); }
};

/// Not yet written.
inline SurfelLight empty_surfel_light(const GBuffer& gbuffer) {
    SurfelLight light;
    light.gathered.width = light.glossy.width = gbuffer.width;
    light.gathered.height = light.glossy.height = gbuffer.height;
    light.gathered.irradiance = Buffer<vec3>(gbuffer.pixels());
    light.glossy.radiance = Buffer<vec3>(gbuffer.pixels());
    return light;
}

}  // namespace interreflect
