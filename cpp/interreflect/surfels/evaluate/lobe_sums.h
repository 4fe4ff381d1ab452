/// Lobes against the light of caches.
#pragma once
#include "data/light_caches.h"
#include "surfels/evaluate/cache_finder.h"

namespace interreflect {

/// Powers of the cosine about an axis, a pixel's each, and the mean radiance over them.
struct Lobes {
    alignas(64) float axis[3][NearCaches::length];  // unit, world space
    alignas(64) float exponent[NearCaches::length];
    vec3 mean[NearCaches::length];  // never negative
};

/// The means of the first `count` lobes, between the caches near their pixels.
void sum_lobes(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes);

}  // namespace interreflect
