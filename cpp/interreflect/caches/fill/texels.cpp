#include "caches/fill/texels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"

namespace interreflect {
namespace {

/// A power of two at which an image's largest radiance is at most 2^14: within half floats.
float image_scale(const Environment& environment) {
    constexpr std::size_t block = 65536;
    const std::size_t texels = environment.image.size();
    std::vector<float> most((texels + block - 1) / block, 0.0f);
    parallel_blocks(texels, block, [&](std::size_t begin, std::size_t end) {
        float largest = 0.0f;
        for (std::size_t i = begin; i < end; ++i)
            largest = std::max(largest, max_component(environment.image[i] * environment.radiance));
        most[begin / block] = largest;
    });
    const float largest = most.empty() ? 0.0f : *std::max_element(most.begin(), most.end());
    return largest > 0.0f ? std::exp2(std::ceil(std::log2(largest)) - 14.0f) : 1.0f;
}

}  // namespace

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
        if (scene.environment->width > 0) {
            filled.sky = Buffer<std::uint16_t>(halves);
            filled.sky_scale = image_scale(*scene.environment);
        }
    }
    filled.counts.caches = filled.places->size();
    return filled;
}

}  // namespace interreflect
