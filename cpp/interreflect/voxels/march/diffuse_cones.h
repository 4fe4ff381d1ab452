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
#include "voxels/march/march_knobs.h"
#include "voxels/march/openness.h"

namespace interreflect {

/// Cones over the hemisphere, marched through ever coarser levels of the pyramid [Crassin et al. 2011].
struct DiffuseCones : MarchKnobs, OcclusionKnob {
    std::string set = "cosine";
    int cones = 40;
    double half_angle = 0.0;

    DiffuseCones() : MarchKnobs{.step = 0.75, .normal_offset = 0.75, .level_bias = -1.25, .density = 0.9} {}
    bool operator==(const DiffuseCones&) const = default;
    static constexpr auto description =
        describe("DiffuseCones", "Cones over the hemisphere, marched front to back through ever coarser levels of the pyramid.",
                 Source{"Crassin et al. 2011; Rehfeld et al. 2014, 4; Freed 2018, 4.5.2"},
                 Param{"set", &DiffuseCones::set,
                       "which cones: `cosine` integrates radiance ~ cos exactly; the thesis's five of 45 degrees full aperture, "
                       "equal weights "
                       "(.7365 for radiance ~ cos, where .6667 is right); its program's six of 60",
                       Unit::none, one_of("cosine|freed_thesis|six_60")},
                 Param{"cones", &DiffuseCones::cones, "cones of the set `cosine`", Unit::none, between(3, 256)},
                 Param{"half_angle", &DiffuseCones::half_angle, "half aperture; 0: the set's own", Unit::degrees, between(0, 70)},
                 MarchKnobs::params, OcclusionKnob::params);
};

GatheredLight march(const DiffuseCones& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene,
                    const Intersector& intersector, const Share& share, std::uint32_t seed);

}  // namespace interreflect
