#include "visibility/ray_rate.h"

#include <algorithm>
#include <vector>

#include "math/parallel.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "math/stopwatch.h"
#include "visibility/intersector.h"

namespace interreflect {
namespace {

constexpr int rings = 256, side = 512, block = 1024;
constexpr std::size_t ray_count = std::size_t{side} * side;

/// A sphere of radius 1, every vertex moved inwards at random by up to a hundredth, about the length of an edge.
std::shared_ptr<const Geometry> rough_sphere() {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= rings; ++j) {
            const float theta = pi * static_cast<float>(i) / rings, phi = 2 * pi * static_cast<float>(j % rings) / rings;
            const bool pole = i == 0 || i == rings;
            const auto number = static_cast<std::uint32_t>(pole ? i : i * rings + j % rings);
            const float radius = 1.0f - 0.01f * unit_float(hash32(number));
            positions.push_back(radius * vec3(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < rings; ++j) {
            const std::uint32_t a = i * (rings + 1) + j, b = a + rings + 1;
            triangles.push_back({a, b, a + 1});
            triangles.push_back({a + 1, b, b + 1});
        }
    const MeshView mesh{positions, triangles, {}, {}, 0};
    const Placement placement;
    return make_geometry({&mesh, 1}, {&placement, 1});
}

/// Through the pixels of a square picture seen from the middle, row by row in packets of 4 x 4, 90 degrees wide.
std::vector<Ray> pixel_rays() {
    std::vector<Ray> rays;
    rays.reserve(ray_count);
    for (int y0 = 0; y0 < side; y0 += 4)
        for (int x0 = 0; x0 < side; x0 += 4)
            for (int k = 0; k < 16; ++k) {
                const int column = x0 + k % 4, row = y0 + k / 4;
                const float x = (static_cast<float>(column) + 0.5f) * 2 / side - 1;
                const float y = (static_cast<float>(row) + 0.5f) * 2 / side - 1;
                rays.push_back({vec3(0), 0, glm::normalize(vec3(x, y, -1)), 4});
            }
    return rays;
}

/// From what the given rays met in a random direction about the sphere's normal there, density cos / pi.
std::vector<Ray> bounced(const std::vector<Ray>& rays, const std::vector<Hit>& hits) {
    std::vector<Ray> result;
    result.reserve(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Rng random(1, static_cast<std::uint32_t>(i));
        const vec3 local = cosine_hemisphere({random.uniform(), random.uniform()});
        const vec3 place = hits[i].distance * 0.999f * rays[i].direction;
        result.push_back({place, 0, Frame(-rays[i].direction).to_world(local), 4});
    }
    return result;
}

template <class Trace>
double best_rate(int repeats, const Trace& trace) {
    double best = 0;
    for (int k = 0; k < repeats; ++k) {
        const Stopwatch watch;
        parallel_blocks(ray_count, block, trace);
        best = std::max(best, static_cast<double>(ray_count) / watch.milliseconds() * 1e-3);
    }
    return best;
}

}  // namespace

RayRates measure_ray_rates(int repeats) {
    const Material solid;
    const Intersector intersector(rough_sphere(), {&solid, 1}, {});
    std::vector<Hit> hits(ray_count);
    std::vector<std::uint8_t> blocked(ray_count);
    const auto of = [](auto& items, std::size_t begin, std::size_t end) { return std::span(items.data() + begin, end - begin); };
    RayRates rates;
    const std::vector<Ray> primary = pixel_rays();
    rates.coherent = best_rate(repeats, [&](std::size_t begin, std::size_t end) {
        intersector.nearest_coherent(of(primary, begin, end), of(hits, begin, end));
    });
    const std::vector<Ray> bounce = bounced(primary, hits);
    rates.incoherent = best_rate(repeats, [&](std::size_t begin, std::size_t end) {
        intersector.nearest_incoherent(of(bounce, begin, end), of(hits, begin, end));
    });
    rates.occlusion = best_rate(repeats, [&](std::size_t begin, std::size_t end) {
        intersector.occluded_incoherent(of(bounce, begin, end), of(blocked, begin, end));
    });
    return rates;
}

}  // namespace interreflect
