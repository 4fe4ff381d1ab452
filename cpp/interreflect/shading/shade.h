/// Shade: from light gathered at the pixels to light that leaves them towards the camera.
#pragma once
#include "data/gathered_light.h"
#include "data/gbuffer.h"

namespace interreflect {

/// Indirect light: albedo / pi * irradiance of what surfaces reflect, and what the glossy lobe reflects of them where `glossy` is
/// not null. The environment's share, `sky`, is direct light and not part of it.
Buffer<vec3> shade(const GBuffer& gbuffer, const GatheredLight& light, const GlossyLight* glossy);

}  // namespace interreflect
