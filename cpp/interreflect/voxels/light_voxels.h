/// Light voxels: which radiance does the surface in each voxel reflect from the lights?
///
///   LitVoxels light_voxels(const Technique&, const LightSampler&, const Intersector&, std::shared_ptr<const VoxelGrid>, seed);
///
/// Radiance = albedo / pi * irradiance: of delta lights, emitters and environment, not of other voxels. Emission is not included.
/// The front (by winding) is lit: a wall's inside where its triangles face inwards, one side of a curtain. Techniques may light
/// the back as well. Exact counterpart: TracedLighting.
#pragma once
#include <variant>

#include "voxels/light_voxels/traced_lighting.h"

namespace interreflect {
using LightVoxels = std::variant<TracedLighting>;
}
