#include "surfels/link/visible_surfels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "math/radical_inverse.h"
#include "math/sampling.h"
#include "math/spiral.h"
#include "visibility/surface.h"

namespace interreflect {
namespace {

/// Rays to surfels that are waiting to be traced, and the solid angle that each adds.
class RaysToSurfels {
  public:
    RaysToSurfels(const Intersector& intersector, std::span<float> solid_angle)
        : intersector_(intersector), solid_angle_(solid_angle) {}

    void add(const vec3& from, const vec3& to, std::size_t surfel, float weight) {
        packet_.set(count_, {from, 0.0f, to - from, 1.0f});
        surfel_[count_] = surfel, weight_[count_] = weight;
        if (++count_ == RayPacket::width) flush();
    }
    void flush() {
        if (count_ == 0) return;
        const std::uint32_t active = (1U << count_) - 1U;
        for (std::uint32_t open = active & ~intersector_.occluded(packet_, active); open != 0; open &= open - 1) {
            const int lane = std::countr_zero(open);
            solid_angle_[surfel_[lane]] += weight_[lane];
        }
        rays_ += static_cast<std::uint64_t>(count_);
        count_ = 0;
    }
    std::uint64_t rays() const { return rays_; }

  private:
    RayPacket packet_;  // first: it is aligned to 64 bytes
    const Intersector& intersector_;
    std::span<float> solid_angle_;
    std::size_t surfel_[RayPacket::width];
    float weight_[RayPacket::width];
    int count_ = 0;
    std::uint64_t rays_ = 0;
};

constexpr std::uint32_t no_surfel = std::numeric_limits<std::uint32_t>::max();
constexpr float near_spacings = 4.0f;
constexpr float spacings_a_cell = 2.0f;
constexpr float smallest_cell = std::numeric_limits<float>::min();  // scene units; of a tree without area

/// Side of a square of the surfels' mean area.
float spacing_of(const ClusteredSurfels& surfels) {
    const std::size_t n = surfels.surfels.size();
    return n > 0 ? std::sqrt(surfels.tree.area[surfels.tree.nodes() - 1] / static_cast<float>(n)) : 0.0f;
}

}  // namespace

VisibleSurfels::VisibleSurfels(const ClusteredSurfels& surfels, const Scene& scene, const Intersector& intersector,
                               const Sampling& sampling)
    : surfels_(surfels.surfels),
      scene_(scene),
      intersector_(intersector),
      offset_(surfels.surfels.size()),
      grid_(surfels.surfels.position.span(), std::max(spacings_a_cell * spacing_of(surfels), smallest_cell)) {
    if (sampling.rays == 1) disk_.push_back(vec2(0));
    for (int k = 0; sampling.rays > 1 && k < sampling.rays; ++k)
        disk_.push_back(concentric_disk({(static_cast<float>(k) + 0.5f) / static_cast<float>(sampling.rays),
                                         radical_inverse(2, static_cast<std::uint32_t>(k))}));
    for (int k = 0; k < sampling.near_rays; ++k) directions_.push_back(spiral(k, sampling.near_rays));
    if (sampling.near_rays > 0) near_ = near_spacings * spacing_of(surfels);
    for (std::size_t i = 0; i < offset_.size(); ++i) offset_[i] = self_hit_offset(*scene.geometry, 0, surfels_.triangle[i]);
}

void VisibleSurfels::look(const CacheSites& sites, std::size_t cache, std::span<const std::uint32_t> only, float weight,
                          SeenSurfels& seen, Counts& counts) const {
    const vec3 normal = sites.normal[cache], from = sites.position[cache] + normal * sites.offset[cache];
    seen.from = from;
    const bool half = normal != vec3(0);
    std::ranges::fill(seen.solid_angle, 0.0f);
    seen.near.clear();
    if (near_ > 0.0f) look_near(normal, seen, counts);
    RaysToSurfels sight(intersector_, seen.solid_angle);
    const float share = weight / static_cast<float>(disk_.size());
    for (std::size_t k = 0; k < (only.empty() ? surfels_.size() : only.size()); ++k) {
        const std::size_t i = only.empty() ? k : only[k];
        const vec3 n = surfels_.normal[i], at = surfels_.position[i];
        const vec3 towards = at - from;
        if (glm::dot(n, towards) >= 0.0f || (half && glm::dot(normal, towards) <= 0.0f)) continue;
        if (glm::dot(towards, towards) < near_ * near_) continue;
        const float area = surfels_.area[i];
        const Frame frame(n);
        const float radius = std::sqrt(area / pi);
        for (const vec2& d : disk_) {
            const vec3 point = disk_.size() > 1 ? at + (frame.tangent * d.x + frame.bitangent * d.y) * radius : at;
            const vec3 to = point - from;
            const float d2 = glm::dot(to, to), cosine = -glm::dot(n, to) / std::sqrt(d2);
            if (!(cosine > 0.0f) || (half && glm::dot(normal, to) <= 0.0f)) continue;
            // Without rays to what is near, an area in the denominator bounds a surfel's solid angle by pi.
            sight.add(from, point + n * offset_[i], i, area * cosine / (d2 + (near_ > 0.0f ? 0.0f : area / pi)) * share);
        }
    }
    sight.flush();
    counts.shadow_rays += sight.rays();
}

void VisibleSurfels::look_near(const vec3& normal, SeenSurfels& seen, Counts& counts) const {
    constexpr std::size_t most = 64;
    std::array<Ray, most> rays;
    std::array<Hit, most> hits;
    seen.near_weight = 4.0f * pi / static_cast<float>(directions_.size());
    std::size_t count = 0;
    const auto trace = [&] {
        intersector_.nearest_incoherent({rays.data(), count}, {hits.data(), count});
        for (std::size_t k = 0; k < count; ++k) {
            if (!hits[k].valid()) continue;
            const std::uint32_t surfel = surfel_at(hits[k], rays[k].direction);
            if (surfel == no_surfel) continue;
            seen.near.push_back({surfel, rays[k].direction});
            seen.solid_angle[surfel] += seen.near_weight;
        }
        counts.rays += count;
        count = 0;
    };
    for (const vec3& direction : directions_) {
        if (normal != vec3(0) && glm::dot(normal, direction) <= 0.0f) continue;
        rays[count] = {seen.from, 0.0f, direction, near_};
        if (++count == most) trace();
    }
    trace();
    std::ranges::stable_sort(seen.near, {}, &NearHit::surfel);
}

std::uint32_t VisibleSurfels::surfel_at(const Hit& hit, const vec3& direction) const {
    if (hit.instance != 0) return no_surfel;  // bodies send nothing on
    const Corners c = world_corners(*scene_.geometry, 0, hit.triangle);
    const vec3 at = c.a + (c.b - c.a) * hit.u + (c.c - c.a) * hit.v;
    const vec3 across = glm::normalize(glm::cross(c.b - c.a, c.c - c.a));
    const vec3 normal = glm::dot(across, direction) < 0.0f ? across : -across;
    std::uint32_t nearest = no_surfel;
    float least = std::numeric_limits<float>::infinity();
    grid_.for_each_near(at, [&](std::uint32_t i) {
        if (!same_side(normal, surfels_.normal[i])) return;
        const vec3 to = surfels_.position[i] - at;
        const float d2 = glm::dot(to, to);
        if (d2 < least || (d2 == least && i < nearest)) least = d2, nearest = i;
    });
    return nearest;
}

}  // namespace interreflect
