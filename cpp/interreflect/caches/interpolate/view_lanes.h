/// The parts of a pixel's view that are found for many pixels at once.
#pragma once
#include "caches/interpolate/pixel_views.h"

namespace interreflect {

/// Reads what stands in the G-buffer at views.pixel, which holds pixels up to a whole vector of lanes, into `views` and as lobes
/// of all of them, for whose albedo `specular` is their reflectance. Returns whether any of them has a lobe.
bool load_pixels(const GBuffer& gbuffer, PixelViews& views, Reflections& lobes, float (*specular)[PixelViews::capacity]);

/// Enters the lobes' directions and albedos into the views of pixels that have one, and one level for all.
void enter_lobes(const Reflections& lobes, const float (*specular)[PixelViews::capacity], float level, PixelViews& views);

/// How levels follow from solid angles.
struct LevelOfWidth {
    float texel;  // sr
    float bias, last;
};

/// Enters the levels of lobes that are uniform cones.
void find_levels(const LevelOfWidth& width, const float* half_angles, PixelViews& views);

/// Finds the levels that lobes are read from.
void bound_levels(PixelViews& views);

/// Finds the bounds of all groups.
void bound_groups(PixelViews& views);

}  // namespace interreflect
