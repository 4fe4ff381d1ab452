/// Pixels that no cache serves.
#pragma once
#include <vector>

#include "caches/interpolate/own_caches.h"
#include "caches/interpolate/weights.h"

namespace interreflect {

/// Counts the pixels of weight 0, and lights them as the knob says.
void light_uncovered(const WeightKnobs& knobs, const ConvolvedCaches& caches, const GBuffer& gbuffer, const Scene& scene,
                     const OwnCaches& own, CacheLight& light);

}  // namespace interreflect
