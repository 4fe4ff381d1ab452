/// From sums of caches to a pixel's light.
#pragma once
#include "caches/interpolate/cache_light.h"
#include "caches/interpolate/pixel_views.h"

namespace interreflect {

/// Enters the light of a pixel whose sum's weight is above 0.
void finish_pixel(const ConvolvedCaches& caches, const PixelViews::View& view, const CacheSum& sum, CacheLight& light);

}  // namespace interreflect
