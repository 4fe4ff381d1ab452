#include "direct/surface_filter.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {
namespace {

/// Weight of a neighbour `steps` pixels away. Off the plane by as many pixel widths as it is away counts exp(-1); a normal turned
/// by 30 degrees counts a fifth.
float neighbour_weight(const GBuffer& g, std::size_t centre, std::size_t other, int steps, float pixel_angle) {
    if (!g.hit(other)) return 0.0f;
    if (steps == 0) return 1.0f;
    const float facing = std::fmax(0.0f, glm::dot(g.normal[centre], g.normal[other]));
    const float facing2 = facing * facing, facing4 = facing2 * facing2, facing8 = facing4 * facing4;
    const float height = std::fabs(glm::dot(g.geometric_normal[centre], g.position[other] - g.position[centre]));
    const float width = g.depth[centre] * pixel_angle * static_cast<float>(steps);
    return facing8 * facing2 * facing * std::exp(-height / width);
}

/// One direction; `stride` from one neighbour to the next.
Buffer<vec3> filter_lines(const Buffer<vec3>& values, const GBuffer& g, int radius, bool rows, float pixel_angle) {
    Buffer<vec3> result(values.size());
    parallel_blocks(g.height, 8, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < g.width; ++x) {
                const std::size_t pixel = static_cast<std::size_t>(y) * g.width + x;
                if (!g.hit(pixel)) {
                    result[pixel] = vec3(0);
                    continue;
                }
                const int at = rows ? x : y, last = (rows ? g.width : g.height) - 1;
                const std::ptrdiff_t stride = rows ? 1 : g.width;
                vec3 sum(0);
                float weights = 0;
                for (int k = -std::min(radius, at); k <= std::min(radius, last - at); ++k) {
                    const auto other = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(pixel) + k * stride);
                    const float weight = neighbour_weight(g, pixel, other, std::abs(k), pixel_angle);
                    sum += values[other] * weight;
                    weights += weight;
                }
                result[pixel] = sum / weights;
            }
    });
    return result;
}

}  // namespace

Buffer<vec3> filter_along_surfaces(const Buffer<vec3>& values, const GBuffer& g, int radius) {
    const float angle = CameraRays(g.camera, g.width, g.height).pixel_angle();
    return filter_lines(filter_lines(values, g, radius, true, angle), g, radius, false, angle);
}

}  // namespace interreflect
