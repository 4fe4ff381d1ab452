#pragma once
#include <cstdint>

#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "data/scene.h"
#include "data/technique.h"
#include "data/voxel_grid.h"
#include "visibility/intersector.h"
#include "voxels/march/march_knobs.h"

namespace interreflect {

/// One cone about the lobe's mean direction, as wide as the lobe in its mean resultant length R: a uniform cone of half angle a
/// has R = (1 + cos a) / 2. (For a Phong lobe of exponent n about the mirror direction that is cos a = n / (n + 2).) What it sees
/// is weighted by the lobe's directional albedo at that view, so a uniform world reflects exactly that.
struct GlossyCone : MarchKnobs {
    bool operator==(const GlossyCone&) const = default;
    static constexpr auto description = describe(
        "GlossyCone", "One cone about the lobe's mean direction, as wide as the lobe, weighted by the lobe's directional albedo.",
        Source{"Crassin et al. 2011; Rehfeld et al. 2014, 4"}, MarchKnobs::params);
};

GlossyLight glossy(const GlossyCone& technique, const Pyramid& pyramid, const GBuffer& gbuffer, const Scene& scene,
                   const Intersector& intersector, std::uint32_t seed);

}  // namespace interreflect
