#pragma once
#include "data/light_caches.h"
#include "data/scene.h"
#include "data/technique.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Caches in the middles of the cells of a box about the scene, for light from everywhere [Jendersie et al. 2016, 4.4]. One that
/// sees more backs of surfaces than `most_backs` of all it sees lies in a solid, or behind a wall, and is left out. Several
/// levels are the paper's future work: "another option would be the use of a cascaded volume. In any case, all caches must have
/// precomputed linkage, but it is not necessary to illuminate and use all of them" [6]. Pixels read the level that reaches them
/// from the camera, and between four fifths of a level's reach and its end the next one as well; surfels of further bounces read
/// the coarsest. Pixels look a quarter of a cell before their surfaces, so that caches behind a wall count less (Cornell box,
/// 12 x 8 x 12 cells: relMSE .41 to .17; Sponza: .58 to .63 of the light); from half a cell on light comes into dark corners.
struct CacheGrid {
    int nx = 24;
    int ny = 8;
    int nz = 12;
    double most_backs = 0.3;
    int levels = 1;
    double reach = 4.0;
    double normal_offset = 0.25;

    bool operator==(const CacheGrid&) const = default;
    static constexpr auto description = describe(
        "CacheGrid", "Caches in the middles of the cells of a box about the scene.",
        Source{"Jendersie et al. 2016", "4.4; back faces: 5.2; levels: 6, future work"},
        Param{"nx", &CacheGrid::nx, "cells along x", Unit::none, between(1, 1024)},
        Param{"ny", &CacheGrid::ny, "cells along y", Unit::none, between(1, 1024)},
        Param{"nz", &CacheGrid::nz, "cells along z", Unit::none, between(1, 1024)},
        Param{"most_backs", &CacheGrid::most_backs,
              "share of what a cache sees that may be backs of surfaces; 1: none is left out", Unit::none, between(0, 1)},
        Param{"levels", &CacheGrid::levels, "grids over each other, each with half as many cells along an axis as the one before",
              Unit::none, between(1, most_grid_levels)},
        Param{"reach", &CacheGrid::reach, "how many of a level's cells, by their longest side, from the camera pixels read it",
              Unit::none, between(0.1, 1000)},
        Param{"normal_offset", &CacheGrid::normal_offset,
              "how far along their geometric normals pixels look, cells: caches behind a wall count less; 0 as in the paper",
              Unit::none, between(0, 2)});
};

/// box: what the cells fill, world space.
CacheSites place_caches(const CacheGrid& technique, const Scene& scene, const Intersector& intersector, const Bounds& box);

}  // namespace interreflect
