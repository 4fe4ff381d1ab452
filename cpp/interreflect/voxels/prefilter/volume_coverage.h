#pragma once
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "voxels/prefilter/filter_knobs.h"

namespace interreflect {

/// The mean of eight [Freed 2018, 4.4]: keeps the volume's energy, and lets a thin wall fade from level to level.
struct VolumeCoverage : IsotropicKnobs {
    bool operator==(const VolumeCoverage&) const = default;
    static constexpr auto description = describe("VolumeCoverage", "A texel is the mean of the eight below it.",
                                                 Source{"Freed 2018", "4.4"}, IsotropicKnobs::params);
};

Pyramid prefilter(const VolumeCoverage& technique, const LitVoxels& lit);

}  // namespace interreflect
