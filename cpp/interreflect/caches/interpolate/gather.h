#pragma once
#include "caches/interpolate/own_caches.h"
#include "caches/interpolate/weights.h"

namespace interreflect {

/// Every pixel looks at the caches of the tiles around it [Rehfeld et al. 2014, 3.3].
struct Gather : WeightKnobs {
    bool operator==(const Gather&) const = default;
    static constexpr auto description = describe(
        "Gather", "Every pixel takes the weighted mean of the caches in the tiles around it, each read for its own lobes.",
        Source{"Rehfeld et al. 2014, 3.3"}, WeightKnobs::params);
};

CacheLight interpolate(const Gather& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own);

}  // namespace interreflect
