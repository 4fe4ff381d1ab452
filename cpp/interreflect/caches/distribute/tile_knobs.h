/// The knobs of techniques that place caches by tiles of pixels.
#pragma once
#include <tuple>

#include "data/technique.h"

namespace interreflect {

struct TileKnobs {
    int caches = 4096;
    int tile = 16;

    bool operator==(const TileKnobs&) const = default;
    static constexpr auto params = std::tuple{
        Param{"caches", &TileKnobs::caches, "how many are wanted: tiles get the size that comes nearest; 0: as `tile` says",
              Unit::none, between(0, 1 << 22)},
        Param{"tile", &TileKnobs::tile, "side of a tile where `caches` is 0", Unit::pixels, between(1, 4096)}};
};

struct SliceKnob {
    double slice_depth = 4.0;

    bool operator==(const SliceKnob&) const = default;
    static constexpr auto params = std::tuple{Param{"slice_depth", &SliceKnob::slice_depth,
                                                    "how deep a cluster is, in widths of its tile there: 1 makes cubes [Olsson "
                                                    "et al. 2012], of which slanted surfaces need many; 0: not cut by depth",
                                                    Unit::tiles, between(0, 64)}};
};

}  // namespace interreflect
