#pragma once
#include <variant>

#include "data/technique.h"
#include "voxels/light_voxels/bounces.h"

namespace interreflect {

/// Blends in the last frame's radiance [Freed 2018, 4.7.2], and, where asked for, lights only one slab of the voxels a frame and
/// keeps the last radiance of the others [5.4].
///
/// radiance = weight * last frame's + (1 - weight) * new. The last frame's voxel is the one that holds the centre of the new
/// voxel's cell in world space, so history stays in its place when the domain moves. Voxels that the last frame did not have are
/// lit anew, whatever their slab.
struct BlendHistory {
    double weight = 0.8;
    int slabs = 1;
    std::variant<TracedLighting, ShadowMapInjection, ConeLighting, Bounces> light_voxels;

    bool operator==(const BlendHistory&) const = default;
    static constexpr auto description = describe(
        "BlendHistory", "A technique whose light is blended with the last frame's, or brought to a part of the voxels a frame.",
        Source{"Freed 2018", "4.7.2 and 5.4"}, Param{"light_voxels", &BlendHistory::light_voxels, "how voxels are lit anew"},
        Param{"weight", &BlendHistory::weight, "of the last frame's radiance", Unit::none, between(0, 1)},
        Param{"slabs", &BlendHistory::slabs, "slabs of the domain along z, of which one a frame is lit, in turn", Unit::none,
              between(1, 1024)});
};

LitVoxels light_voxels(const BlendHistory& technique, const LightingTask& task);

}  // namespace interreflect
