/// What caches add up to, for pixels side by side.
#pragma once
#include <algorithm>

#include "caches/interpolate/cache_light.h"
#include "caches/interpolate/pixel_views.h"

namespace interreflect {

/// CacheSum of each of PixelViews, in parallel arrays; and where in the maps of caches that stand upright on one plane they look.
struct CacheSums {
    static constexpr int capacity = PixelViews::capacity;

    alignas(64) float weight[capacity];
    alignas(64) float diffuse[4][capacity], glossy[4][capacity], diffuse_sky[4][capacity], glossy_sky[4][capacity];

    /// Places in the square of hemisphere maps whose axis is `normal`: of vectors of lanes that were looked for.
    struct Places {
        vec3 normal{0};
        std::uint64_t known = 0;  // a bit for each vector
        alignas(64) float diffuse[2][capacity], glossy[2][capacity];
    } places;

    void clear(int count) {
        const int whole = (count + PixelViews::most_lanes - 1) / PixelViews::most_lanes * PixelViews::most_lanes;
        const auto zero = [whole](float* values) { std::fill_n(values, whole, 0.0f); };
        zero(weight);
        for (int k = 0; k < 4; ++k) zero(diffuse[k]), zero(glossy[k]), zero(diffuse_sky[k]), zero(glossy_sky[k]);
        places.known = 0;
    }
    void add(int i, const CacheSum& one, float by) {
        weight[i] += by;
        for (int k = 0; k < 4; ++k) diffuse[k][i] += one.diffuse[k] * by, glossy[k][i] += one.glossy[k] * by;
        for (int k = 0; k < 3; ++k) diffuse_sky[k][i] += one.diffuse_sky[k] * by, glossy_sky[k][i] += one.glossy_sky[k] * by;
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
