#include "surfels/place/spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "math/parallel.h"
#include "surfels/place/surfel_grid.h"

namespace interreflect {

Buffer<float> surfel_spacing(const Surfels& surfels) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Buffer<float> spacing(surfels.size(), infinity);
    std::vector<std::uint32_t> open(surfels.size());
    std::iota(open.begin(), open.end(), 0U);
    float radius = 0;
    for (const float area : surfels.area) radius = std::max(radius, 2.0f * std::sqrt(area));
    // Few have none within the first radius; each of the others looks on in a coarser grid.
    for (; !open.empty() && radius > 0; radius *= 4) {
        const SurfelGrid grid(surfels.position.span(), radius);
        parallel_blocks(open.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                const std::uint32_t i = open[k];
                float nearest = infinity;
                grid.for_each_near(surfels.position[i], [&](std::uint32_t j) {
                    if (j == i || !same_side(surfels.normal[i], surfels.normal[j])) return;
                    nearest = std::min(nearest, glm::length(surfels.position[j] - surfels.position[i]));
                });
                if (nearest <= radius) spacing[i] = nearest / std::sqrt(surfels.area[i]);
            }
        });
        std::erase_if(open, [&](std::uint32_t i) { return spacing[i] < infinity; });
        if (radius > 2 * surfels.extent) break;
    }
    return spacing;
}

}  // namespace interreflect
