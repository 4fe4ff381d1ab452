/// The steps of a cone: where it samples which level of the pyramid. They depend on the step's number only, so all cones of one
/// angle share one table.
#pragma once
#include <vector>

#include "data/voxel_grid.h"

namespace interreflect {

/// How cones are marched; lengths in voxels of the finest level or in diameters of the cone.
struct ConeShape {
    float half_angle = 0;      // radians
    float first_diameter = 0;  // voxels, at the cone's start
    float step = 0.5f;         // diameters
    float level_bias = 0;      // levels added to log2(diameter / voxel)
    float density = 1;         // optical depth of a texel as a multiple of what its opacity says
    float correlation = 0;     // of what blocks the cone at one step and before it, from level 2 on
    enum class Start { opening, rays, height } start = Start::opening;
    float start_height = 0;          // voxels, of the first sample where the apex is the start
    float step_growth = 1;           // of `step`, from step to step
    int most_steps = 0;              // 0: no limit
    bool opacity_correction = true;  // else a step's opacity is its texel's, to the power of `density`
};

struct ConeSchedule {
    struct Step {
        float distance;     // from the cone's start, voxels
        float reach;        // how far the filter reaches from the sample, voxels
        float exponent;     // the step's opacity = 1 - (1 - opacity of the level)^exponent
        float blend;        // share of the next coarser level, in [0, 1)
        int level;          // the finer of the two levels
        float correlation;  // of what blocks the cone here and before
        float lod;          // level before it is clamped to those there are
        float density;  // optical depth of a texel of the finest level as a multiple of what its opacity says; uncorrected: of
                        // any texel
    };
    std::vector<Step> steps;
    bool opacity_correction = true;  // whether a step's opacity depends on its length
};

/// Steps until the cone has left any domain of the pyramid's size, or has come `way` voxels far. Where the
/// domain is warped, lengths are in voxels as they are at the cone's start. The diameter starts at `first_diameter` and the first
/// sample lies half a step away; distance and level then grow by one multiplication and one addition a step [Rehfeld et al. 2014,
/// 4]. There `alpha` must be the half angle (ERRATA). Starting as rays, steps are those of a cone one voxel wide until it is.
/// Starting at a height, samples lie at the beginning of their steps [Freed 2018, listing 4.1]; steps are no shorter than those
/// of `first_diameter`, lest a cone of half angle 0 never advance (ERRATA). A step's opacity is 1 - (1 - a)^(its length in
/// texels); the listing blends a.
ConeSchedule make_schedule(const ConeShape& shape, const Pyramid& pyramid);
ConeSchedule make_schedule(const ConeShape& shape, const Pyramid& pyramid, float way);

}  // namespace interreflect
