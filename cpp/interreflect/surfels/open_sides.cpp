#include "surfels/open_sides.h"

#include <cstdint>
#include <vector>

#include "math/parallel.h"
#include "surfels/sites/backs.h"
#include "visibility/surface.h"

namespace interreflect {
namespace {

/// More backs than that, and a place lies in a solid.
constexpr float most_backs = 0.5f;

bool is_open(const Surfels& fronts, std::size_t i, float side, const Scene& scene, const Intersector& intersector) {
    const vec3 normal = fronts.normal[i] * side;
    const float offset = self_hit_offset(*scene.geometry, 0, fronts.triangle[i]);
    const Sight sight = look_about(fronts.position[i] + normal * offset, normal, scene, intersector);
    return sight.seen > 0 && sight.share_of_backs() <= most_backs;
}

}  // namespace

Surfels open_sides(const Surfels& fronts, const Scene& scene, const Intersector& intersector) {
    const std::size_t n = fronts.size();
    std::vector<std::uint8_t> open(2 * n);  // front and back of each
    parallel_blocks(n, 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            open[2 * i] = is_open(fronts, i, 1.0f, scene, intersector) ? 1 : 0;
            const bool reflects = scene.materials[scene.material_of(fronts.triangle[i])].two_sided;
            open[2 * i + 1] = reflects && is_open(fronts, i, -1.0f, scene, intersector) ? 1 : 0;
        }
    });
    std::size_t count = 0;
    for (const std::uint8_t one : open) count += one;
    Surfels kept = make_surfels(count);
    kept.extent = fronts.extent;
    for (std::size_t side = 0, next = 0; side < 2 * n; ++side) {
        if (open[side] == 0) continue;
        const std::size_t i = side / 2;
        kept.position[next] = fronts.position[i], kept.normal[next] = fronts.normal[i] * (side % 2 == 0 ? 1.0f : -1.0f);
        kept.area[next] = fronts.area[i], kept.triangle[next] = fronts.triangle[i];
        kept.barycentric[next++] = fronts.barycentric[i];
    }
    return kept;
}

}  // namespace interreflect
