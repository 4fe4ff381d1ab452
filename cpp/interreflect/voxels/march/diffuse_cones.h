#pragma once
#include <cstdint>
#include <string>

#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "shading/share.h"
#include "visibility/intersector.h"

namespace interreflect {

/// Cones over the hemisphere, marched through ever coarser levels of the pyramid [Crassin et al. 2011].
struct DiffuseCones {
    std::string set = "cosine";
    int cones = 40;
    double half_angle = 0.0;
    double step = 0.75;
    double first_diameter = 0.75;
    double normal_offset = 0.75;
    double level_bias = -1.0;
    double density = 0.9;
    double cut_off = 0.02;
    bool own_surface = false;

    bool operator==(const DiffuseCones&) const = default;
    static constexpr auto description = describe(
        "DiffuseCones", "Cones over the hemisphere, marched front to back through ever coarser levels of the pyramid.",
        Source{"Crassin et al. 2011; Rehfeld et al. 2014, 4; Freed 2018, 4.5.2"},
        Param{"set", &DiffuseCones::set,
              "which cones: `cosine` integrates radiance ~ cos exactly; the thesis's five of 45 degrees; its program's six of 60",
              Unit::none, one_of("cosine|freed_thesis|freed_program")},
        Param{"cones", &DiffuseCones::cones, "cones of the set `cosine`", Unit::none, between(3, 256)},
        Param{"half_angle", &DiffuseCones::half_angle, "half aperture; 0: the set's own", Unit::degrees, between(0, 70)},
        Param{"step", &DiffuseCones::step, "length of a step", Unit::diameters, between(0.1, 2)},
        Param{"first_diameter", &DiffuseCones::first_diameter, "diameter at the cone's start", Unit::voxels, between(0.25, 8)},
        Param{"normal_offset", &DiffuseCones::normal_offset, "how far off the surface cones start, along its geometric normal",
              Unit::voxels, between(0, 8)},
        Param{"level_bias", &DiffuseCones::level_bias,
              "levels added to that whose texels are as wide as the cone; -1: a filter as wide (in variance) as the cone",
              Unit::none, between(-3, 3)},
        Param{"density", &DiffuseCones::density, "optical depth of a texel as a multiple of what its opacity says", Unit::none,
              between(0.1, 10)},
        Param{"cut_off", &DiffuseCones::cut_off, "a cone ends when less than this is open", Unit::none, between(0, 0.5)},
        Param{"own_surface", &DiffuseCones::own_surface,
              "whether cones also see the plane they start from, as the papers' do; else its expected share is taken out"});
};

GatheredLight march(const DiffuseCones& technique, const Pyramid& pyramid, const GBuffer& gbuffer, const Scene& scene,
                    const Intersector& intersector, const Share& share, std::uint32_t seed);

}  // namespace interreflect
