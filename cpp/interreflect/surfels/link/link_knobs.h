/// What techniques that store links share.
#pragma once
#include <string>
#include <tuple>

#include "data/technique.h"

namespace interreflect {

struct LinkKnobs {
    int links = 128;
    int bands = 4;
    int rays = 1;
    int near_rays = 512;
    std::string pull = "flux";

    bool operator==(const LinkKnobs&) const = default;
    static constexpr auto params = std::tuple{
        Param{"links", &LinkKnobs::links, "nodes of the tree that each cache is linked to", Unit::none, between(1, 65536)},
        Param{"bands", &LinkKnobs::bands, "of the caches' spherical harmonics", Unit::none, between(1, 8)},
        Param{"rays", &LinkKnobs::rays, "to each surfel, for its visibility", Unit::samples, between(1, 1024)},
        Param{"near_rays", &LinkKnobs::near_rays,
              "directions in which a cache looks for what is nearer than four surfels' spacings; 0: rays to surfels alone, as in "
              "the paper",
              Unit::samples, between(0, 65536)},
        Param{"pull", &LinkKnobs::pull,
              "what the tree sums up: flux, so that links hold one over the patch's area, or the mean radiosity", Unit::none,
              one_of("flux|radiosity")}};
};

}  // namespace interreflect
