/// What caches add up to, for pixels side by side.
#pragma once
#include "caches/interpolate/cache_light.h"
#include "caches/interpolate/pixel_views.h"

namespace interreflect {

/// CacheSum of each of PixelViews, in parallel arrays.
struct CacheSums {
    static constexpr int capacity = PixelViews::capacity;

    alignas(64) float weight[capacity];
    alignas(64) float diffuse[4][capacity], glossy[4][capacity], diffuse_sky[4][capacity], glossy_sky[4][capacity];

    void set(int i, const CacheSum& sum) {
        weight[i] = sum.weight;
        for (int k = 0; k < 4; ++k) diffuse[k][i] = sum.diffuse[k], glossy[k][i] = sum.glossy[k];
        for (int k = 0; k < 3; ++k) diffuse_sky[k][i] = sum.diffuse_sky[k], glossy_sky[k][i] = sum.glossy_sky[k];
    }
    CacheSum at(int i) const {
        return {{diffuse[0][i], diffuse[1][i], diffuse[2][i], diffuse[3][i]},
                {glossy[0][i], glossy[1][i], glossy[2][i], glossy[3][i]},
                {diffuse_sky[0][i], diffuse_sky[1][i], diffuse_sky[2][i]},
                {glossy_sky[0][i], glossy_sky[1][i], glossy_sky[2][i]},
                weight[i]};
    }
};

}  // namespace interreflect
