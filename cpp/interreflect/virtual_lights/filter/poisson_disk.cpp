#include "virtual_lights/filter/poisson_disk.h"

#include "math/rng.h"
#include "math/sampling.h"

namespace interreflect {

const std::array<vec2, most_disk_points>& poisson_disk() {
    static const auto points = [] {
        std::array<vec2, most_disk_points> made{};
        Rng random(1, 0);
        for (int i = 0; i < most_disk_points; ++i) {
            constexpr int candidates = 256;
            float furthest = -1.0f;
            for (int k = 0; k < candidates; ++k) {
                const float u = random.uniform();
                const vec2 candidate = concentric_disk({u, random.uniform()});
                float least = 4.0f;
                for (int j = 0; j < i; ++j) least = glm::min(least, glm::length(made[j] - candidate));
                if (least > furthest) furthest = least, made[i] = candidate;
            }
        }
        return made;
    }();
    return points;
}

}  // namespace interreflect
