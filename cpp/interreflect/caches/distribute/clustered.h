#pragma once
#include "caches/distribute/tile_knobs.h"
#include "data/caches.h"
#include "data/gbuffer.h"
#include "data/scene.h"

namespace interreflect {

/// Clusters of pixels that share tile, depth slice and the signed axis of three to which their normal is nearest, the axes
/// adapted to the tile's normals [Rehfeld et al. 2014, 3.2].
struct Clustered : TileKnobs, SliceKnob {
    int bins = 8;
    double smoothing = 20.0;
    double exponent = 8.0;

    bool operator==(const Clustered&) const = default;
    static constexpr auto description = describe(
        "Clustered",
        "One cache for the pixels that share tile, depth slice and the nearest of three axes adapted to the tile's normals.",
        Source{"Rehfeld et al. 2014, 3.2; Olsson et al. 2012"}, TileKnobs::params, SliceKnob::params,
        Param{"bins", &Clustered::bins, "side of the histogram of normals, an octahedral map", Unit::none, between(2, 32)},
        Param{"smoothing", &Clustered::smoothing, "standard deviation of the Gaussian that smooths it", Unit::degrees,
              between(0, 90)},
        Param{"exponent", &Clustered::exponent, "how fast directions beside a chosen axis regain their rating", Unit::none,
              between(0, 1e6)});
};

CachePlaces distribute(const Clustered& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces* last);

}  // namespace interreflect
