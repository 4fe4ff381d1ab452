/// The knobs that every technique which marches cones has.
///
/// Listing 4.1 of Freed 2018 in these terms: `steps` is most_steps, `bias` normal_offset, `coneAngle` twice the half angle,
/// `coneHeight` start_height with start = height, `lodOffset` level_bias, the loop's end at alpha .95 cut_off = .05, and the
/// height that grows by the radius step = .5. It has no opacity_correction, and sees its own_surface. Rehfeld et al. 2014, 4:
/// start = opening with a first_diameter of .75 is the paper's compromise between start = rays and coarser levels at once, a
/// first_diameter of 1; the steps of claim R7 are .5 and 1.
#pragma once
#include <string>

#include "data/technique.h"
#include "math/vectors.h"
#include "voxels/march/cone_schedule.h"

namespace interreflect {

struct MarchKnobs {
    double step = 0.5;
    double first_diameter = 0.75;
    double normal_offset = 1.5;
    double level_bias = -1.0;
    double density = 1.0;
    double correlation = 0.0;
    double cut_off = 0.02;
    bool own_surface = false;
    std::string start = "opening";
    double start_height = 1.0;
    int most_steps = 0;
    double step_growth = 1.0;
    bool opacity_correction = true;

    bool operator==(const MarchKnobs&) const = default;
    /// half_angle: radians.
    ConeShape shape(float half_angle) const {
        return {half_angle,
                static_cast<float>(first_diameter),
                static_cast<float>(step),
                static_cast<float>(level_bias),
                static_cast<float>(density),
                static_cast<float>(correlation),
                start == "rays"     ? ConeShape::Start::rays
                : start == "height" ? ConeShape::Start::height
                                    : ConeShape::Start::opening,
                static_cast<float>(start_height),
                static_cast<float>(step_growth),
                most_steps,
                opacity_correction};
    }

    static constexpr auto params = std::tuple{
        Param{"step", &MarchKnobs::step, "length of a step", Unit::diameters, between(0.1, 2)},
        Param{"first_diameter", &MarchKnobs::first_diameter, "diameter at the cone's start", Unit::voxels, between(0.25, 8)},
        Param{"normal_offset", &MarchKnobs::normal_offset, "how far off the surface cones start, along its geometric normal",
              Unit::voxels, between(0, 8)},
        Param{"level_bias", &MarchKnobs::level_bias,
              "levels added to that whose texels are as wide as the cone; -1: a filter as wide (in variance) as the cone",
              Unit::none, between(-3, 3)},
        Param{"density", &MarchKnobs::density, "optical depth of a texel as a multiple of what its opacity says", Unit::none,
              between(0.1, 10)},
        Param{
            "correlation", &MarchKnobs::correlation,
            "how far what blocks a wide cone (from level 2 on) covers the same part of it at every step: 0 not at all, as in the "
            "papers; 1 wholly, as walls along the cone do, but then slanted walls leak",
            Unit::none, between(0, 1)},
        Param{"cut_off", &MarchKnobs::cut_off, "a cone ends when less than this is open", Unit::none, between(0, 0.5)},
        Param{"own_surface", &MarchKnobs::own_surface,
              "whether cones also see the plane they start from, as the papers' do; else its expected share is taken out"},
        Param{
            "start", &MarchKnobs::start,
            "how a cone begins: `opening` as wide as first_diameter; `rays` as a ray, by steps for a voxel's width in the finest "
            "level, until it is one voxel wide; `height` with its apex at the start and its first sample at start_height",
            Unit::none, one_of("opening|rays|height")},
        Param{"start_height", &MarchKnobs::start_height, "distance of the first sample where start = height", Unit::voxels,
              between(0, 16)},
        Param{"most_steps", &MarchKnobs::most_steps, "a cone ends after so many steps, and is open beyond; 0: no limit",
              Unit::none, between(0, 4096)},
        Param{"step_growth", &MarchKnobs::step_growth,
              "factor on `step` from each step to the next, up to 2 diameters: coarser steps far along the cone", Unit::none,
              between(1, 2)},
        Param{"opacity_correction", &MarchKnobs::opacity_correction,
              "whether a step's opacity follows from its length in texels; else each blends the texel's own, as in the papers",
              Unit::none}};
};

}  // namespace interreflect
