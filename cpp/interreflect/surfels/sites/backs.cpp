#include "surfels/sites/backs.h"

#include <array>

#include "math/spiral.h"

namespace interreflect {
namespace {

constexpr int directions = 64;

bool shows_back(const Hit& hit, const vec3& direction, const Scene& scene) {
    const Corners c = world_corners(*scene.geometry, hit.instance, hit.triangle);
    const float facing = glm::dot(glm::cross(c.b - c.a, c.c - c.a), direction);
    return (scene.geometry->instances[hit.instance].flips ? -facing : facing) > 0.0f;
}

}  // namespace

Sight look_about(const vec3& position, const vec3& normal, const Scene& scene, const Intersector& intersector) {
    std::array<Ray, directions> rays;
    std::array<Hit, directions> hits;
    std::size_t count = 0;
    for (int k = 0; k < directions; ++k)
        if (const vec3 d = spiral(k, directions); normal == vec3(0) || glm::dot(normal, d) > 0.0f)
            rays[count++] = {position, 0.0f, d};
    intersector.nearest_incoherent({rays.data(), count}, {hits.data(), count});
    Sight sight;
    for (std::size_t k = 0; k < count; ++k) {
        sight.seen += hits[k].valid() ? 1 : 0;
        sight.backs += hits[k].valid() && shows_back(hits[k], rays[k].direction, scene) ? 1 : 0;
    }
    return sight;
}

}  // namespace interreflect
