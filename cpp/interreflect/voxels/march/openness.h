/// The papers' ambient occlusion on top of what blending attenuates.
#pragma once
#include "data/technique.h"
#include "voxels/march/march_cones.h"

namespace interreflect {

/// Of techniques whose cones gather radiance.
struct OcclusionKnob {
    bool multiply_by_occlusion = false;

    bool operator==(const OcclusionKnob&) const = default;
    static constexpr auto params = std::tuple{Param{
        "multiply_by_occlusion", &OcclusionKnob::multiply_by_occlusion,
        "whether a cone's radiance is multiplied by the share of it that is open, as in Freed 2018, algorithm 3; blending has "
        "attenuated it already (ERRATA)"}};
};

/// Each cone's radiance times the share of it that is open [Freed 2018, algorithm 3].
inline void multiply_by_openness(ConeBatch& batch) {
    for (int i = 0; i < batch.count; ++i) batch.r[i] *= batch.open[i], batch.g[i] *= batch.open[i], batch.b[i] *= batch.open[i];
}

}  // namespace interreflect
