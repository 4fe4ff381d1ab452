#pragma once
#include "caches/distribute/tile_knobs.h"
#include "data/caches.h"
#include "data/gbuffer.h"
#include "data/scene.h"

namespace interreflect {

/// Clusters of pixels that share tile, depth slice and a cell of the cube that their normal points to, its faces cut into n x n:
/// the clusters that Rehfeld et al. 2014 adapt to the normals.
struct CubeFaceClustered : TileKnobs, SliceKnob {
    int subdivisions = 3;

    bool operator==(const CubeFaceClustered&) const = default;
    static constexpr auto description = describe(
        "CubeFaceClustered", "One cache for the pixels that share tile, depth slice and a cell of a cube's faces.",
        Source{"Olsson et al. 2012"}, TileKnobs::params, SliceKnob::params,
        Param{"subdivisions", &CubeFaceClustered::subdivisions, "cells along each edge of the cube", Unit::none, between(1, 16)});
};

CachePlaces distribute(const CubeFaceClustered& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces* last);

}  // namespace interreflect
