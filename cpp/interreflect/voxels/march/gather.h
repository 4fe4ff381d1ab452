/// From what cones or rays summed up at each pixel to the light gathered there.
#pragma once
#include <span>

#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "shading/share.h"

namespace interreflect {

/// Merges what pixels gathered of their parts (share.h). `voxels`: mean radiance (times `scale` is irradiance) and openness.
/// `sky`: mean radiance of the environment through the openings; empty where it is the same from everywhere, namely `constant`.
GatheredLight merge_gathered(const Share& share, const GBuffer& gbuffer, std::span<const float> weights,
                             const Buffer<vec4>& voxels, float scale, const Buffer<vec4>& sky, const vec3& constant,
                             std::span<const Counts> counts);

/// `voxels` (times `scale`) and `sky`: what each pixel's lobe reflects.
GlossyLight finish_glossy(const GBuffer& gbuffer, const Buffer<vec4>& voxels, float scale, const Buffer<vec4>& sky,
                          std::span<const Counts> counts);

}  // namespace interreflect
