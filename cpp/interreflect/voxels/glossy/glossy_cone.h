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

/// One cone about the lobe's mean direction, as wide as the lobe in its mean resultant length R: a uniform cone of half angle a
/// has R = (1 + cos a) / 2. (For a Phong lobe of exponent n about the mirror direction that is cos a = n / (n + 2).) What it sees
/// is weighted by the lobe's directional albedo at that view, so a uniform world reflects exactly that. Of the pixels that share,
/// the first of each block sends its cone; the others take the mean of what their neighbours saw, weighted by their own albedo,
/// or, where no neighbour on their surface has a lobe as wide, send their own.
struct GlossyCone : MarchKnobs, OcclusionKnob {
    std::string aperture = "lobe";
    double half_angle = 0.0;
    Share share = EveryPixel{};

    GlossyCone() : MarchKnobs{} {}  // g++ 12 takes the implicit one's strings for uninitialized
    bool operator==(const GlossyCone&) const = default;
    static constexpr auto description = describe(
        "GlossyCone", "One cone about the lobe's mean direction, as wide as the lobe, weighted by the lobe's directional albedo.",
        Source{"Crassin et al. 2011; Rehfeld et al. 2014, 4; Freed 2018, 4.5.2"},
        Param{"aperture", &GlossyCone::aperture,
              "how wide: `lobe` as its mean resultant length says, about its mean direction; `freed` 0.1 pi roughness in full, "
              "about "
              "the mirrored view",
              Unit::none, one_of("lobe|freed")},
        Param{"half_angle", &GlossyCone::half_angle, "half aperture of every cone; 0: as `aperture` says", Unit::degrees,
              between(0, 60)},
        Param{"share", &GlossyCone::share,
              "whether each pixel sends its cone, or one of a block does for its neighbours on the same surface with the same "
              "lobe"},
        MarchKnobs::params, OcclusionKnob::params);
};

GlossyLight glossy(const GlossyCone& technique, Pyramids pyramids, const GBuffer& gbuffer, const Scene& scene,
                   const Intersector& intersector, std::uint32_t seed);

}  // namespace interreflect
