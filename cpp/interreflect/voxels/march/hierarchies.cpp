#include "voxels/march/hierarchies.h"

#include <algorithm>
#include <stdexcept>

namespace interreflect {
namespace {

/// A sphere about a hierarchy, world space.
struct Sphere {
    vec3 centre;
    float radius;
};

Sphere sphere_about(const Pyramid& pyramid) {
    const Domain& domain = pyramid.domain;
    // A view volume begins at its eye.
    if (domain.warp.view_volume()) return {domain.lower, domain.longest_way() * domain.voxel_size};
    const vec3 lower = domain.lower, upper = domain.upper();
    return {pyramid.pose.to_world(0.5f * (lower + upper)), 0.5f * glm::length(upper - lower)};
}

}  // namespace

Hierarchies::Hierarchies(Pyramids pyramids) {
    if (pyramids.empty()) throw std::invalid_argument("pyramids must hold at least one");
    for (const Pyramid* pyramid : pyramids) {
        const Sphere own = sphere_about(*pyramid);
        float way = 0;
        for (const Pyramid* other : pyramids) {
            const Sphere from = sphere_about(*other);
            way = std::max(way, glm::length(from.centre - own.centre) + from.radius + own.radius);
        }
        const Domain& domain = pyramid->domain;
        // Lengths of cones through warped voxels are in those of their start.
        const float voxels = domain.plain() ? way / domain.voxel_size : std::max(domain.longest_way(), way / domain.voxel_size);
        parts_.push_back({pyramid, AirMap(*pyramid), voxels + 2.0f});
    }
}

std::uint32_t Hierarchies::owner(std::uint32_t body) const {
    const bool own = std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) { return part.pyramid->pose.body == body; });
    return own ? body : 0;
}

int Hierarchies::first_of(std::uint32_t owner) const {
    for (int i = 0; i < count(); ++i)
        if (pyramid(i).pose.body == owner) return i;
    return 0;
}

}  // namespace interreflect
