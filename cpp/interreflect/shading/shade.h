/// Shade: how do surfaces reflect, and what leaves the pixels towards the camera of the light gathered there?
///
///   std::optional<Lobe> lobe_of(const Technique&);
///
/// A technique names the glossy lobe of the G-buffer's surfaces (empty: their materials'). The G-buffer holds it, so that direct
/// light
/// (`shadow`, `sky`) and the indirect glossy lobe (`glossy`) reflect alike. The diffuse part is albedo / pi in all. Exact
/// counterpart: Exact.
#pragma once
#include <variant>

#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "shading/shade/blinn_phong.h"
#include "shading/shade/exact.h"
#include "shading/shade/freed_cook_torrance.h"

namespace interreflect {
using Shade = std::variant<Exact, FreedCookTorrance, BlinnPhong>;

inline std::optional<Lobe> lobe_of(const Shade& technique) {
    return std::visit([](const auto& one) { return lobe_of(one); }, technique);
}

/// Indirect light: albedo / pi * irradiance of what surfaces reflect, and what the glossy lobe reflects of them where `glossy` is
/// not null. The environment's share, `sky`, is direct light and not part of it.
Buffer<vec3> shade(const GBuffer& gbuffer, const GatheredLight& light, const GlossyLight* glossy);

}  // namespace interreflect
