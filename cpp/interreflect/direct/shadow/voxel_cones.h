/// Shadows by cones through voxels.
#pragma once
#include <span>

#include "data/voxel_grid.h"
#include "direct/shadow/traced_shadows.h"
#include "voxels/march/march_knobs.h"

namespace interreflect {

/// One cone from every pixel to every point, spot and directional light, attenuated by the opacity of the voxels on its way
/// [Rehfeld et al. 2014, 5]: shadows as soft as the cone is wide, which show the voxels. Several pyramids (of bodies that move)
/// multiply what they let through. Emitters get no cones: they are sampled and traced as TracedShadows does.
struct VoxelCones : MarchKnobs {
    double half_angle = 1.0;
    int samples = 4;

    VoxelCones() : MarchKnobs{} {}  // g++ 12 takes the implicit one's strings for uninitialized
    bool operator==(const VoxelCones&) const = default;
    static constexpr auto description = describe(
        "VoxelCones", "A cone through the voxels to every point, spot and directional light; emitters by traced samples.",
        Source{"Rehfeld et al. 2014", "5"},
        Param{"half_angle", &VoxelCones::half_angle, "half aperture", Unit::degrees, between(0, 70)},
        Param{"samples", &VoxelCones::samples, "points on emitters for every pixel", Unit::samples, between(1, 65536)},
        MarchKnobs::params);
};
DirectLight shadow(const VoxelCones& technique, const Scene& scene, const Intersector& intersector, const LightSampler& lights,
                   const GBuffer& gbuffer, std::span<const Pyramid* const> pyramids, std::uint32_t seed);

}  // namespace interreflect
