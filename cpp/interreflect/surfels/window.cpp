#include "surfels/window.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "math/half.h"
#include "math/parallel.h"

namespace interreflect {

float window_scale(std::string_view window, int band, int bands) {
    const float x = pi * static_cast<float>(band) / static_cast<float>(bands);
    if (window == "hanning") return 0.5f * (1.0f + std::cos(x));
    if (window == "lanczos") return band == 0 ? 1.0f : std::sin(x) / x;
    if (window != "none") throw std::invalid_argument("window must be one of none, hanning, lanczos, got " + std::string(window));
    return 1.0f;
}

void window_caches(LightCaches& caches, std::string_view window) {
    // Luma and chrominance are cut at the same width, or colours would fringe.
    float scale[most_bands * most_bands];
    for (int l = 0; l < caches.bands; ++l)
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) scale[i] = window_scale(window, l, caches.bands);
    if (window == "none") return;
    parallel_blocks(caches.caches, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cache = begin; cache < end; ++cache) {
            std::uint16_t* c = caches.coefficients.data() + cache * static_cast<std::size_t>(caches.stride());
            for (const int count : {caches.luma(), caches.chrominance(), caches.chrominance()})
                for (int i = 0; i < count; ++i, ++c) *c = to_half(from_half(*c) * scale[i]);
        }
    });
}

}  // namespace interreflect
