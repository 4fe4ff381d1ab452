#pragma once
#include <memory>
#include <string>

#include "data/caches.h"
#include "data/technique.h"

namespace interreflect {

/// Ever coarser maps, each texel the mean of the finer ones weighted by their solid angles, for glossy lobes; and a coarse table
/// of the mean weighted by the cosine, for the diffuse one [Scherzer et al. 2012; Rehfeld et al. 2014, 3.3].
struct MipChain {
    int table = 7;
    std::string width = "resultant";
    double level_bias = -1.0;

    bool operator==(const MipChain&) const = default;
    static constexpr auto description = describe(
        "MipChain", "Ever coarser maps for glossy lobes, and a table of the cosine lobe.",
        Source{"Rehfeld et al. 2014, 3.3; Scherzer et al. 2012"},
        Param{"table", &MipChain::table, "side of the cosine table; an odd one has a texel at the cache's normal", Unit::texels,
              between(1, 32)},
        Param{"width", &MipChain::width,
              "how wide a lobe is taken to be: `one_percent` where it falls to 1 % of its peak, as in the paper; `resultant` the "
              "uniform cone with its mean resultant length",
              Unit::none, one_of("one_percent|resultant")},
        Param{"level_bias", &MipChain::level_bias,
              "levels added to the one whose texels have the lobe's solid angle; look-ups between texels widen a lobe by "
              "themselves",
              Unit::none, between(-4, 4)});
};

ConvolvedCaches preconvolve(const MipChain& technique, std::shared_ptr<const FilledCaches> filled);

}  // namespace interreflect
