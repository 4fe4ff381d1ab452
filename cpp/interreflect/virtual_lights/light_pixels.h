/// All virtual lights at all pixels: shade_lights and filter_shadows together, shared between pixels.
#pragma once
#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "shading/share.h"
#include "virtual_lights/filter.h"
#include "virtual_lights/shade.h"

namespace interreflect {

/// What virtual lights bring to the pixels. `gathered` holds irradiance alone, no sky and no occlusion.
struct VirtualLight {
    GatheredLight gathered;
    GlossyLight glossy;
    Counts counts;

    std::size_t bytes() const { return gathered.bytes() + glossy.bytes(); }
};

struct LightPixels {
    const ShadeLights& shade;
    const FilterShadows& filter;
    const Share& share;
    std::uint32_t seed = 0;
};

/// std::invalid_argument where the shadows are of another number of lights. Every phase of pixels (share.h) has lights that
/// follow each other. A pixel's glossy lobe is averaged over a circle of the disk's solid angle about its middle; of the lights
/// that Point and ClampedPoint take for points it sees the middle.
VirtualLight light_pixels(const LightPixels& how, const VirtualLights& lights, const LightShadows& shadows,
                          const GBuffer& gbuffer, const Scene& scene, const Intersector& intersector);

}  // namespace interreflect
