/// Pixels that no cache serves.
#pragma once
#include <span>

#include "caches/interpolate/finish.h"
#include "caches/interpolate/own_caches.h"
#include "caches/interpolate/weights.h"

namespace interreflect {

/// Counts the blocks' pixels, and lights those of weight 0 as the knob says.
void light_uncovered(const WeightKnobs& knobs, const ConvolvedCaches& caches, const GBuffer& gbuffer, const Scene& scene,
                     const OwnCaches& own, std::span<const Served> served, CacheLight& light);

}  // namespace interreflect
