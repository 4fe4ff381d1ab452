/// Lobes against the light of caches.
#pragma once
#include "data/light_caches.h"
#include "surfels/evaluate/cache_finder.h"

namespace interreflect {

/// Powers of the cosine about an axis, a pixel's each, and the mean radiance over them.
struct Lobes {
    vec3 axis[NearCaches::length] = {};  // unit, world space
    alignas(64) float exponent[NearCaches::length] = {};
    vec3 mean[NearCaches::length];  // never negative; 0 where no cache is near
};

/// The means of the first `count` lobes, between the caches near their pixels.
void sum_lobes(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes);
/// As with exponents of 1.
void sum_cosines(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes);

}  // namespace interreflect
