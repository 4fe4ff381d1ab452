#pragma once
#include <cstdint>

#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "visibility/intersector.h"

namespace interreflect {

/// One cone about the lobe's mean direction, as wide as the lobe in its mean resultant length R: a uniform cone of half angle a
/// has R = (1 + cos a) / 2. (For a Phong lobe of exponent n about the mirror direction that is cos a = n / (n + 2).) What it sees
/// is weighted by the lobe's directional albedo at that view, so a uniform world reflects exactly that.
struct GlossyCone {
    double step = 0.5;
    double first_diameter = 0.75;
    double normal_offset = 1.5;
    double level_bias = -1.0;
    double density = 1.0;
    double cut_off = 0.02;
    bool own_surface = false;

    bool operator==(const GlossyCone&) const = default;
    static constexpr auto description = describe(
        "GlossyCone", "One cone about the lobe's mean direction, as wide as the lobe, weighted by the lobe's directional albedo.",
        Source{"Crassin et al. 2011; Rehfeld et al. 2014, 4"},
        Param{"step", &GlossyCone::step, "length of a step", Unit::diameters, between(0.1, 2)},
        Param{"first_diameter", &GlossyCone::first_diameter, "diameter at the cone's start", Unit::voxels, between(0.25, 8)},
        Param{"normal_offset", &GlossyCone::normal_offset, "how far off the surface cones start, along its geometric normal",
              Unit::voxels, between(0, 8)},
        Param{"level_bias", &GlossyCone::level_bias, "levels added to that whose texels are as wide as the cone", Unit::none,
              between(-3, 3)},
        Param{"density", &GlossyCone::density, "optical depth of a texel as a multiple of what its opacity says", Unit::none,
              between(0.1, 10)},
        Param{"cut_off", &GlossyCone::cut_off, "a cone ends when less than this is open", Unit::none, between(0, 0.5)},
        Param{"own_surface", &GlossyCone::own_surface,
              "whether cones also see the plane they start from, as the papers' do; else its expected share is taken out"});
};

GlossyLight glossy(const GlossyCone& technique, const Pyramid& pyramid, const GBuffer& gbuffer, const Scene& scene,
                   const Intersector& intersector, std::uint32_t seed);

}  // namespace interreflect
