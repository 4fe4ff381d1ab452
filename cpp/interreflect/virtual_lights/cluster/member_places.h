/// A few texels of every cluster that stand for all of its texels.
#pragma once
#include <span>

#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

/// `cluster`: of every texel; `centres`: each cluster's own texel, which stands for clusters of few texels alone.
Buffer<MemberPlaces> member_places(const LightMaps& maps, const Buffer<std::uint32_t>& cluster,
                                   std::span<const std::uint32_t> centres);

}  // namespace interreflect
