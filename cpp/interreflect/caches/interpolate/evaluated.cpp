#include "caches/interpolate/evaluated.h"

#include <vector>

#include "caches/interpolate/finish.h"

namespace interreflect {

CacheLight interpolate(const Evaluated&, const ConvolvedCaches*, const GBuffer& gbuffer, const Scene& scene,
                       const OwnCaches& own) {
    CacheLight light = empty_cache_light(gbuffer);
    parallel_tiles(gbuffer.width, gbuffer.height, 64, [&](const Tile& tile) { clear_unseen(tile, 0, light); });
    std::vector<std::uint32_t> pixels;
    for (std::size_t i = 0; i < gbuffer.pixels(); ++i)
        if (gbuffer.hit(i)) pixels.push_back(static_cast<std::uint32_t>(i));
    light.counts = light_by_own_caches(own, pixels, gbuffer, scene, light);
    light.counts.covered_pixels = pixels.size();
    return light;
}

}  // namespace interreflect
