/// Light voxels: which radiance does the surface in each voxel reflect from the lights?
///
///   LitVoxels light_voxels(const Technique&, const Scene&, const Intersector&, std::shared_ptr<const VoxelGrid>, seed);
///
/// Radiance = albedo / pi * irradiance: of delta lights, emitters and environment, not of other voxels. Emission is not included.
/// Both sides are lit, each by what arrives there: a curtain may be bright on one side and dark on the other.
/// Exact counterpart: TracedLighting.
#pragma once
#include <variant>

#include "voxels/light_voxels/traced_lighting.h"

namespace interreflect {
using LightVoxels = std::variant<TracedLighting>;
}
