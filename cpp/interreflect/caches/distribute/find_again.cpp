#include "caches/distribute/find_again.h"

#include <cmath>
#include <optional>

#include "math/parallel.h"

namespace interreflect {
namespace {

/// How an instance moved since the last frame. What did not move keeps its bits.
struct Step {
    bool moved = false;
    mat3 turn{1.0f}, normal_turn{1.0f};
    vec3 from{0}, to{0};

    Step(const mat4x3& before, const mat4x3& now) : moved(before != now) {
        if (!moved) return;
        turn = mat3(now) * glm::inverse(mat3(before));
        normal_turn = glm::transpose(glm::inverse(turn));
        from = before[3], to = now[3];
    }
    vec3 point(const vec3& p) const { return moved ? turn * (p - from) + to : p; }
    vec3 normal(const vec3& n) const { return moved ? glm::normalize(normal_turn * n) : n; }
};

/// Where a point is seen, pixels from the upper left corner; nothing where the picture does not show it.
std::optional<vec2> project(const CameraRays& rays, const vec3& position) {
    const vec3 away = position - rays.origin;
    const float depth = glm::dot(away, rays.forward);
    if (!(depth > 0.0f)) return {};
    const vec3 in_plane = away / depth - rays.corner;
    const vec2 at(glm::dot(in_plane, rays.right_step) / glm::dot(rays.right_step, rays.right_step),
                  glm::dot(in_plane, rays.down_step) / glm::dot(rays.down_step, rays.down_step));
    const bool inside =
        at.x >= 0.0f && at.y >= 0.0f && at.x < static_cast<float>(rays.width) && at.y < static_cast<float>(rays.height);
    return inside ? std::optional(at) : std::nullopt;
}

}  // namespace

std::vector<SeenAgain> find_again(const ReuseCaches& technique, const CachePlaces& last, const GBuffer& gbuffer,
                                  const Scene& scene, float tile_angle) {
    const CachePlaces::Track& track = *last.track;
    const std::vector<Instance>& instances = scene.geometry->instances;
    std::vector<Step> steps;
    for (std::size_t i = 0; i < std::min(instances.size(), track.poses.size()); ++i)
        steps.emplace_back(track.poses[i], instances[i].world_from_local);
    const CameraRays rays(gbuffer.camera, gbuffer.width, gbuffer.height);
    // Only a picture taken anew from the same place shows what did not move at the same pixels, bit for bit.
    const bool same_view = track.camera == gbuffer.camera && last.width == gbuffer.width && last.height == gbuffer.height;
    const float off = static_cast<float>(technique.max_distance) * tile_angle;
    const float least_cosine = std::cos(static_cast<float>(technique.max_angle) * degrees_to_radians);
    std::vector<SeenAgain> seen(last.size());
    parallel_blocks(last.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            SeenAgain& cache = seen[i];
            cache.last = no_cache;
            if (track.instance[i] >= steps.size()) continue;
            const Step& step = steps[track.instance[i]];
            cache.position = step.point(last.position[i]);
            cache.normal = step.normal(last.normal[i]), cache.geometric_normal = step.normal(last.geometric_normal[i]);
            if (same_view && !step.moved) {
                cache.screen = last.screen[i], cache.pixel = last.pixel[i];
            } else {
                const std::optional<vec2> at = project(rays, cache.position);
                if (!at) continue;
                cache.screen = *at;
                cache.pixel = static_cast<std::uint32_t>(at->y) * static_cast<std::uint32_t>(gbuffer.width) +
                              static_cast<std::uint32_t>(at->x);
            }
            const std::uint32_t p = cache.pixel;
            if (!gbuffer.hit(p) || gbuffer.body[p] != last.body[i]) continue;
            const float above = glm::dot(gbuffer.position[p] - cache.position, cache.geometric_normal);
            const float distance = glm::length(cache.position - gbuffer.camera.position);
            if (!(std::fabs(above) <= off * distance)) continue;
            // The slack is for the rounding of unit vectors.
            if (!(glm::dot(gbuffer.normal[p], cache.normal) >= least_cosine - 1e-6f)) continue;
            cache.last = static_cast<std::uint32_t>(i);
        }
    });
    std::erase_if(seen, [](const SeenAgain& cache) { return cache.last == no_cache; });
    return seen;
}

}  // namespace interreflect
