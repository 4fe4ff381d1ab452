#include "voxels/march/cone_environment.h"

#include <algorithm>

#include "data/environment.h"
#include "math/octahedral_map.h"
#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr int map_size = 32;                          // 4.5 degrees a texel
constexpr int source_width = 64, source_height = 32;  // 5.6 degrees a texel
constexpr float texel_angle = pi / source_height;

/// Direction, solid angle and mean radiance of a patch of the sky.
struct Patch {
    vec3 direction, radiance;
    float solid_angle;
};

/// The image in patches: each is the mean of its texels weighted by their solid angles.
std::vector<Patch> coarse_patches(const Environment& environment) {
    std::vector<Patch> patches(source_width * source_height);
    parallel_pieces(source_height, [&](std::size_t row) {
        const int height = environment.height, width = environment.width, y = static_cast<int>(row);
        // At least one texel a patch: small images are looked up more than once.
        const int y0 = y * height / source_height, y1 = std::max(y0 + 1, (y + 1) * height / source_height);
        for (int x = 0; x < source_width; ++x) {
            const int x0 = x * width / source_width, x1 = std::max(x0 + 1, (x + 1) * width / source_width);
            vec3 sum(0);
            float weight = 0;
            for (int j = y0; j < y1; ++j) {
                const float sine = std::sin(pi * (static_cast<float>(j) + 0.5f) / static_cast<float>(height));
                for (int i = x0; i < x1; ++i) sum += environment.image[static_cast<std::size_t>(j) * width + i] * sine;
                weight += sine * static_cast<float>(x1 - x0);
            }
            const vec2 centre((static_cast<float>(x) + 0.5f) / source_width, (static_cast<float>(y) + 0.5f) / source_height);
            const float angle =
                std::cos(pi * static_cast<float>(y) / source_height) - std::cos(pi * static_cast<float>(y + 1) / source_height);
            patches[y * source_width + x] = {environment_direction(environment, centre), sum / weight * environment.radiance,
                                             angle * 2.0f * pi / source_width};
        }
    });
    return patches;
}

}  // namespace

ConeEnvironment::ConeEnvironment(const Scene& scene, float half_angle) {
    if (!scene.environment) return;
    environment_ = &*scene.environment;
    constant_ = environment_->radiance;
    if (environment_->width == 0) return;
    const auto patches = coarse_patches(*environment_);
    map_.resize(map_size * map_size);
    // A patch counts in proportion to how far it lies inside; cones narrower than a patch still find one.
    const float angle = std::max(half_angle, 0.75f * texel_angle);
    const float outer = std::cos(std::min(angle + 0.5f * texel_angle, pi)),
                inner = std::cos(std::max(angle - 0.5f * texel_angle, 0.0f));
    parallel_pieces(map_size, [&](std::size_t row) {
        for (int x = 0; x < map_size; ++x) {
            const vec3 axis =
                octahedral_direction({(static_cast<float>(x) + 0.5f) / map_size, (static_cast<float>(row) + 0.5f) / map_size});
            vec3 sum(0);
            float weight = 0;
            for (const auto& patch : patches) {
                const float inside = std::clamp((glm::dot(axis, patch.direction) - outer) / (inner - outer), 0.0f, 1.0f);
                sum += patch.radiance * (inside * patch.solid_angle);
                weight += inside * patch.solid_angle;
            }
            map_[row * map_size + x] = sum / weight;
        }
    });
}

vec3 ConeEnvironment::mean(const vec3& direction) const {
    if (map_.empty()) return constant_;
    // Bilinear; the map's border is the seam of the lower half, where clamping costs at most half a texel.
    const vec2 p = glm::clamp(octahedral_square(direction) * static_cast<float>(map_size) - 0.5f, 0.0f, map_size - 1.0f);
    const int x = std::min(static_cast<int>(p.x), map_size - 2), y = std::min(static_cast<int>(p.y), map_size - 2);
    const float fx = p.x - static_cast<float>(x), fy = p.y - static_cast<float>(y);
    const vec3* row = map_.data() + y * map_size + x;
    return glm::mix(glm::mix(row[0], row[1], fx), glm::mix(row[map_size], row[map_size + 1], fx), fy);
}

}  // namespace interreflect
