#include "caches/fill/texels.h"

#include <stdexcept>
#include <string>

namespace interreflect {

FilledCaches empty_maps(std::shared_ptr<const CachePlaces> places, int resolution, float scale, const Scene& scene) {
    constexpr std::size_t most_bytes = std::size_t{4} << 30;
    FilledCaches filled;
    filled.resolution = resolution;
    filled.scale = scale;
    const std::size_t halves = 4 * places->size() * filled.texels_each();
    if (halves * sizeof(std::uint16_t) > most_bytes)
        throw std::invalid_argument("fill: " + std::to_string(places->size()) + " caches of " + std::to_string(resolution) +
                                    " x " + std::to_string(resolution) + " texels need more than 4 GiB");
    filled.places = std::move(places);
    filled.texels = Buffer<std::uint16_t>(halves);
    if (scene.environment) {
        filled.sky_radiance = scene.environment->radiance;
        if (scene.environment->width > 0) filled.sky = Buffer<std::uint16_t>(halves);
    }
    filled.counts.caches = filled.places->size();
    return filled;
}

}  // namespace interreflect
