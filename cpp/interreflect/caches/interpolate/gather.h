#pragma once
#include "caches/interpolate/own_caches.h"
#include "caches/interpolate/weights.h"

namespace interreflect {

/// Every pixel looks at the caches of the tiles around it [Rehfeld et al. 2014, 3.3].
struct Gather : WeightKnobs {
    std::string search = "tiles";

    Gather() : WeightKnobs{} {}  // g++ 12 takes the implicit one's strings for uninitialized
    bool operator==(const Gather&) const = default;
    static constexpr auto description = describe(
        "Gather", "Every pixel takes the weighted mean of the caches in the tiles around it, each read for its own lobes.",
        Source{"Rehfeld et al. 2014, 3.3 and 6"}, WeightKnobs::params,
        Param{
            "search", &Gather::search,
            "how caches near some pixels are found, which changes no weight: by the `tiles` within the radius on the screen, or, "
            "as the paper proposes, by a bounding volume `hierarchy` over their reach in space",
            Unit::none, one_of("tiles|hierarchy")});
};

CacheLight interpolate(const Gather& technique, const ConvolvedCaches* caches, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own);

}  // namespace interreflect
