/// Last frame's caches in this frame.
#pragma once
#include <vector>

#include "caches/distribute/reuse_caches.h"

namespace interreflect {

/// A cache of the last frame that is seen in this one.
struct SeenAgain {
    std::uint32_t last;   // its number in the last frame
    std::uint32_t pixel;  // that sees it
    vec3 position, normal, geometric_normal;
    vec2 screen;
};

/// Those that are valid, in the last frame's order. tile_angle: this frame's, radians.
std::vector<SeenAgain> find_again(const ReuseCaches& technique, const CachePlaces& last, const GBuffer& gbuffer,
                                  const Scene& scene, float tile_angle);

}  // namespace interreflect
