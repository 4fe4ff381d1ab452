#include "voxels/march/cone_caster.h"

#include <algorithm>
#include <cmath>

namespace interreflect {

ConeCaster::ConeCaster(const Pyramid& pyramid, const MarchKnobs& knobs, float half_angle)
    : pyramid_(pyramid), knobs_(knobs), schedule_(make_schedule(knobs.shape(half_angle), pyramid)), air_(pyramid) {}

Counts ConeCaster::cast(std::span<const Cone> cones, ConeBatch& batch) const {
    const Domain& domain = pyramid_.domain;
    const auto offset = static_cast<float>(knobs_.normal_offset);
    batch.count = static_cast<int>(cones.size());
    batch.limited = true;
    for (int i = 0; i < batch.count; ++i) {
        const Cone& cone = cones[static_cast<std::size_t>(i)];
        const vec3 surface = domain.to_linear(cone.position);
        set_start(batch, i, domain, surface, cone.normal, offset, knobs_.own_surface);
        vec3 direction = cone.direction;
        batch.limit[i] = cone.distance;
        if (std::isfinite(cone.distance)) {
            // The cone starts off the surface: from there a near light lies elsewhere.
            const vec3 start(batch.x[i], batch.y[i], batch.z[i]);
            const vec3 to_light = surface + direction * (cone.distance / domain.voxel_size) - start;
            const float distance = glm::length(to_light);
            if (distance > 0.0f) direction = to_light / distance;
            batch.limit[i] = distance - 1.0f;
        }
        set_direction(batch, i, direction);
    }
    const ConeCounts done = march_cones(pyramid_, air_, schedule_, static_cast<float>(knobs_.cut_off), batch);
    Counts counts;
    counts.cones = cones.size(), counts.cone_steps = done.steps, counts.voxel_fetches = done.fetches;
    return counts;
}

ShadowCones::ShadowCones(std::span<const Pyramid* const> pyramids, const MarchKnobs& knobs, float half_angle) {
    casters_.reserve(pyramids.size());
    for (const Pyramid* pyramid : pyramids) casters_.emplace_back(*pyramid, knobs, half_angle);
}

Counts ShadowCones::open(std::span<const ConeCaster::Cone> cones, std::span<float> share) const {
    thread_local ConeBatch batch;
    Counts counts;
    std::fill(share.begin(), share.end(), 1.0f);
    for (const ConeCaster& caster : casters_) {
        counts += caster.cast(cones, batch);
        for (std::size_t i = 0; i < cones.size(); ++i) share[i] *= batch.open[i];
    }
    return counts;
}

}  // namespace interreflect
