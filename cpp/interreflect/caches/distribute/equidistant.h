#pragma once
#include "caches/distribute/tile_knobs.h"
#include "data/caches.h"
#include "data/gbuffer.h"
#include "data/scene.h"

namespace interreflect {

/// A cache at every tile's middle pixel, whatever it sees: what Rehfeld et al. 2014, figure 6, compare with. Where that is sky,
/// the tile has none.
struct Equidistant : TileKnobs {
    bool operator==(const Equidistant&) const = default;
    static constexpr auto description = describe("Equidistant", "A cache at the middle pixel of every tile.",
                                                 Source{"Rehfeld et al. 2014, figure 6"}, TileKnobs::params);
};

CachePlaces distribute(const Equidistant& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces* last);

}  // namespace interreflect
