#pragma once
#include "caches/interpolate/own_caches.h"
#include "caches/interpolate/weights.h"

namespace interreflect {

/// Every cache is added to the pixels within its sphere of influence, whose sums are normalised in the end [Scherzer et al. 2012;
/// Rehfeld et al. 2014, 3.3].
struct Splat : WeightKnobs {
    std::string weight = "world";

    Splat() : WeightKnobs{} {}  // g++ 12 takes the implicit one's strings for uninitialized
    bool operator==(const Splat&) const = default;
    static constexpr auto description = describe(
        "Splat", "Every cache adds to the pixels within its reach; the sums are normalised in the end.",
        Source{"Scherzer et al. 2012; Rehfeld et al. 2014, 3.3"}, WeightKnobs::params,
        Param{"weight", &Splat::weight,
              "which: that in space (`world`; the screen's radius then does not matter), or the lesser of it and the screen's",
              Unit::none, one_of("world|minimum")});
};

CacheLight interpolate(const Splat& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own);

}  // namespace interreflect
