/// The texels of hemisphere maps: half floats, and the maps they are written to.
#pragma once
#include <glm/gtc/packing.hpp>

#include "data/caches.h"
#include "data/scene.h"

namespace interreflect {

inline constexpr float largest_half = 65504.0f;

inline void write_texel(std::uint16_t* texel, const vec3& radiance, float open) {
    for (int k = 0; k < 3; ++k) texel[k] = glm::packHalf1x16(glm::min(radiance[k], largest_half));
    texel[3] = glm::packHalf1x16(open);
}
inline vec4 read_texel(const std::uint16_t* texel) {
    return {glm::unpackHalf1x16(texel[0]), glm::unpackHalf1x16(texel[1]), glm::unpackHalf1x16(texel[2]),
            glm::unpackHalf1x16(texel[3])};
}

/// As write_texel writes them, `count` texels in a row from parallel arrays of at least a whole number of vectors; the texels
/// too.
void pack_texels(const float* r, const float* g, const float* b, const float* open, std::size_t count, std::uint16_t* texel);

/// Maps without content. More of them than 4 GiB are refused (std::invalid_argument).
FilledCaches empty_maps(std::shared_ptr<const CachePlaces> places, int resolution, float scale, const Scene& scene);

}  // namespace interreflect
