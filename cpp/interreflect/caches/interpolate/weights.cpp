#include "caches/interpolate/weights.h"

#include <cmath>
#include <limits>

#include "math/parallel.h"

namespace interreflect {

CacheWeights::CacheWeights(const WeightKnobs& knobs, const CachePlaces& places, bool world_alone)
    : places_(places),
      world_radius_(static_cast<float>(knobs.world_radius)),
      screen_radius_(world_alone ? std::numeric_limits<float>::infinity()
                                 : static_cast<float>(knobs.radius) * static_cast<float>(places.tile)),
      terms_(places.size()) {
    const float least_cosine = std::cos(static_cast<float>(knobs.max_angle) * degrees_to_radians);
    const float slope = 1.0f / std::max(1.0f - least_cosine, 1e-7f);
    parallel_blocks(places.size(), 4096, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            const float world = world_radius(i);
            const bool reaches = world > 0.0f && screen_radius_ > 0.0f;
            terms_[i] = {Frame(places.normal[i]),
                         places.position[i],
                         places.screen[i],
                         reaches ? 1.0f / (world * world) : 0.0f,
                         reaches ? 1.0f / (screen_radius_ * screen_radius_) : 0.0f,
                         reaches ? slope : 0.0f,
                         reaches ? -least_cosine * slope : -1.0f};
        }
    });
}

}  // namespace interreflect
