/// Texels of reflective shadow maps as virtual lights.
#pragma once
#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

/// Light `light` is that texel's surface; `share`: how many of its like it stands for.
void set_texel_light(VirtualLights& lights, std::size_t light, const ReflectiveShadowMap& map, std::size_t texel,
                     std::size_t first_of_map, float share);

/// Number of each map's first texel, and last the number of all.
std::vector<std::size_t> first_texels(const LightMaps& maps);

/// Whether a texel sends light on.
inline bool sends(const ReflectiveShadowMap& map, std::size_t texel) { return max_component(map.flux[texel]) > 0.0f; }

std::vector<int> sizes_of(const LightMaps& maps);

}  // namespace interreflect
