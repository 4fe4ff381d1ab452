/// From the pixels that were chosen to the caches that stand there.
#pragma once
#include <span>

#include "data/caches.h"
#include "data/gbuffer.h"

namespace interreflect {

/// How long a tile is on a surface that an eye sees, along the way it is slanted, scene units. Slants end at a cosine of .1.
float tile_footprint(const vec3& eye, const vec3& position, const vec3& geometric_normal, float tile_angle);

/// The angle of a tile, radians.
float tile_angle(const GBuffer& gbuffer, int tile);

/// Caches at the surfaces of `pixels`. `places` has its tiles; `members` are the pixels of each one's cluster.
void place_caches(const GBuffer& gbuffer, std::span<const std::uint32_t> pixels, std::span<const std::uint32_t> members,
                  CachePlaces& places);

/// An empty distribution over tiles of `tile` pixels; larger ones are as large as the picture.
CachePlaces tiles_of(const GBuffer& gbuffer, int tile);

}  // namespace interreflect
