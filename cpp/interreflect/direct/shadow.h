/// Shadow: what do the pixels reflect of the light that point, spot and directional lights and emitters send them?
///
///   DirectLight shadow(const Technique&, const Scene&, const Intersector&, const LightSampler&, const GBuffer&, seed);
///
/// VoxelCones takes the voxels' pyramids before the seed: one, or more whose transmittances are multiplied. Every technique
/// leaves out the environment (stage sky) and what the surfaces emit themselves (the G-buffer's emission). Exact counterpart:
/// TracedShadows.
#pragma once
#include <variant>

#include "direct/shadow/shadow_map.h"
#include "direct/shadow/traced_shadows.h"
#include "direct/shadow/voxel_cones.h"

namespace interreflect {
using Shadow = std::variant<TracedShadows, ShadowMap, VoxelCones>;
}
