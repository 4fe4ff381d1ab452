/// The knobs that every technique which marches cones has.
#pragma once
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

    bool operator==(const MarchKnobs&) const = default;
    /// half_angle: radians.
    ConeShape shape(float half_angle) const {
        return {half_angle,
                static_cast<float>(first_diameter),
                static_cast<float>(step),
                static_cast<float>(level_bias),
                static_cast<float>(density),
                static_cast<float>(correlation)};
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
              "whether cones also see the plane they start from, as the papers' do; else its expected share is taken out"}};
};

}  // namespace interreflect
