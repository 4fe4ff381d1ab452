/// Light voxels: which radiance does the surface in each voxel reflect from the lights?
///
///   LitVoxels light_voxels(const Technique&, const LightingTask&);
///
/// Radiance = albedo / pi * irradiance: of delta lights, emitters and environment, not of other voxels (but for Bounces).
/// Emission is not included. The front (by winding) is lit: a wall's inside where its triangles face inwards, one side of a
/// curtain. Techniques may light the back as well. BlendHistory and Bounces look at what the last frame left: `task.last`. Exact
/// counterpart: TracedLighting.
#pragma once
#include <variant>

#include "voxels/light_voxels/blend_history.h"
#include "voxels/light_voxels/bounces.h"
#include "voxels/light_voxels/cone_lighting.h"
#include "voxels/light_voxels/shadow_map_injection.h"
#include "voxels/light_voxels/traced_lighting.h"

namespace interreflect {
using LightVoxels = std::variant<TracedLighting, ShadowMapInjection, ConeLighting, Bounces, BlendHistory>;
}  // namespace interreflect
