/// One cut of the tree for every cache, with all that links of any kind keep of it: no technique traces the rays again.
#pragma once
#include "surfels/link/runtime_projection.h"
#include "surfels/link/sh_links.h"

namespace interreflect {

/// `projected` has as many bands as links may have; the first of them are the same bits as those of links of fewer.
struct SharedCut {
    CacheLinks projected, cones;

    std::size_t bytes() const { return projected.bytes() + cones.bytes(); }
};

/// Bands and kind of the knobs do not matter. std::invalid_argument where it would need more than 4 GiB.
SharedCut shared_cut(LinkKnobs knobs, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                     const Intersector& intersector);

/// The same bits as `link`. std::invalid_argument for a cut with other links or another pull.
CacheLinks take_links(const ShLinks& technique, const SharedCut& cut);
CacheLinks take_links(const RuntimeProjection& technique, const SharedCut& cut);

}  // namespace interreflect
