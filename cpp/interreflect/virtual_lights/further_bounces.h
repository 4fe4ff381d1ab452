/// Light of further bounces: virtual lights as lights in turn.
#pragma once
#include <span>

#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

/// What virtual lights see, each over its hemisphere; their maps have size x size texels together.
LightMaps bounce_maps(const Scene& scene, const Intersector& intersector, const VirtualLights& lights, int size);

/// Several lists of lights as one. Clusters are left out.
VirtualLights join_lights(std::span<const VirtualLights* const> lists);

}  // namespace interreflect
