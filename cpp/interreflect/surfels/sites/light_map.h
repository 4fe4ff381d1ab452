#pragma once
#include <span>

#include "data/light_caches.h"
#include "data/scene.h"
#include "data/technique.h"
#include "surfels/sites/cache_grid.h"
#include "visibility/intersector.h"

namespace interreflect {

/// A cache for every texel of a map over the still surface whose centre lies in a triangle's chart [Jendersie et al. 2016, 4.4],
/// and a grid for all that has no chart: bodies, small pieces, and charts of less than four texels. Texels about a chart take
/// the nearest one's cache, so that bilinear look-ups are complete. One that sees more backs of surfaces than `most_backs` lies
/// behind other geometry; it takes its neighbours' cache as well [5.2].
struct LightMap {
    int texels = 128;
    double area_share = 0.95;
    double most_backs = 0.5;
    CacheGrid grid;

    bool operator==(const LightMap&) const = default;
    static constexpr auto description =
        describe("LightMap", "A cache for every texel of a map over the still surface, and a grid for all else.",
                 Source{"Jendersie et al. 2016", "4.4; back faces: 5.2"},
                 Param{"texels", &LightMap::texels, "side of the map", Unit::texels, between(1, 4096)},
                 Param{"area_share", &LightMap::area_share,
                       "of the still surface's area that must have charts: the largest connected pieces that hold it", Unit::none,
                       between(0, 1)},
                 Param{"most_backs", &LightMap::most_backs,
                       "share of what a texel sees that may be backs of surfaces; 1: all texels are kept where they are",
                       Unit::none, between(0, 1)},
                 Param{"grid", &LightMap::grid, "caches for all that has no chart"});
};

/// box: what the grid fills. texcoord: of every corner of every triangle, in texels; negative where the triangle has no chart.
/// std::invalid_argument for another number of corners, for texture coordinates that are not finite or beyond the map.
CacheSites place_caches(const LightMap& technique, const Scene& scene, const Intersector& intersector, const Bounds& box,
                        std::span<const vec2> texcoord);

/// Fills in the planes of a map over a scene. Its triangles must be the still surface's.
void lay_planes(LightMapSites& map, const Scene& scene);

}  // namespace interreflect
