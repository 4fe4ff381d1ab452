#include "voxels/march/cone_caster.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "voxels/march/hit_order.h"

namespace interreflect {
namespace {

constexpr std::size_t capacity = ConeBatch::capacity;

/// How much wider cones start in hierarchy `part` than its voxels say: as wide as they are where they begin, but never narrower
/// than its own voxels can tell.
float start_ratio(const Hierarchies& all, int part, int from) {
    const Domain &own = all.pyramid(from).domain, &domain = all.pyramid(part).domain;
    return domain.plain() ? std::max(1.0f, own.voxel_size / domain.voxel_size) : 1.0f;
}

bool any_ends(std::span<const ConeCaster::Cone> cones) {
    return std::any_of(cones.begin(), cones.end(), [](const auto& cone) { return std::isfinite(cone.distance); });
}

}  // namespace

ConeCaster::ConeCaster(Pyramids pyramids, const MarchKnobs& knobs, float half_angle)
    : ConeCaster(std::make_shared<const Hierarchies>(pyramids), knobs, half_angle) {}

ConeCaster::ConeCaster(std::shared_ptr<const Hierarchies> hierarchies, const MarchKnobs& knobs, float half_angle)
    : hierarchies_(std::move(hierarchies)), knobs_(knobs) {
    const Hierarchies& all = *hierarchies_;
    schedules_.resize(static_cast<std::size_t>(all.count()));
    for (int part = 0; part < all.count(); ++part)
        for (int from = 0; from < all.count(); ++from) {
            auto& known = schedules_[static_cast<std::size_t>(part)];
            const float ratio = start_ratio(all, part, from);
            if (std::any_of(known.begin(), known.end(), [&](const Schedule& one) { return one.ratio == ratio; })) continue;
            ConeShape shape = knobs.shape(half_angle);
            shape.first_diameter *= ratio;
            shape.start_height *= ratio;
            const Pyramid& pyramid = all.pyramid(part);
            known.push_back(
                {ratio, all.alone() ? make_schedule(shape, pyramid) : make_schedule(shape, pyramid, all.longest_way(part))});
        }
}

const ConeSchedule& ConeCaster::schedule(int part, int from) const {
    const auto& known = schedules_[static_cast<std::size_t>(part)];
    const float ratio = start_ratio(*hierarchies_, part, from);
    return std::find_if(known.begin(), known.end(), [&](const Schedule& one) { return one.ratio == ratio; })->steps;
}

Counts ConeCaster::cast(std::span<const Cone> cones, ConeBatch& batch) const {
    if (hierarchies_->alone()) return cast_alone(cones, batch);
    std::array<HitOrder, capacity> seen;
    std::array<std::size_t, capacity> order;
    std::array<std::uint32_t, capacity> owners;
    for (std::size_t i = 0; i < cones.size(); ++i) order[i] = i, owners[i] = hierarchies_->owner(cones[i].body);
    const auto all = std::span(order).first(cones.size());
    std::stable_sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) { return owners[a] < owners[b]; });
    Counts counts;
    counts.cones = cones.size();
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        const std::uint32_t owner = owners[all[begin]];
        while (end < all.size() && owners[all[end]] == owner) ++end;
        const auto chosen = all.subspan(begin, end - begin);
        for (int part = 0; part < hierarchies_->count(); ++part) {
            counts += cast_through(part, owner, cones, chosen, batch);
            const Pyramid& pyramid = hierarchies_->pyramid(part);
            const float scale = pyramid.scale / hierarchies_->pyramid(0).scale;
            for (std::size_t k = 0; k < chosen.size(); ++k)
                seen[chosen[k]].add(vec3(batch.r[k], batch.g[k], batch.b[k]) * scale, batch.open[k],
                                    std::min(batch.depth[k] * pyramid.domain.voxel_size, nothing_there));
        }
    }
    batch.count = static_cast<int>(cones.size());
    for (std::size_t i = 0; i < cones.size(); ++i) {
        const vec3 radiance = seen[i].radiance();
        batch.r[i] = radiance.r, batch.g[i] = radiance.g, batch.b[i] = radiance.b, batch.open[i] = seen[i].open();
        set_direction(batch, static_cast<int>(i), cones[i].direction);
    }
    return counts;
}

Counts ConeCaster::cast_alone(std::span<const Cone> cones, ConeBatch& batch) const {
    const Domain& domain = hierarchies_->pyramid(0).domain;
    const auto offset = static_cast<float>(knobs_.normal_offset);
    batch.count = static_cast<int>(cones.size());
    batch.limited = any_ends(cones);
    batch.merged = false;  // unless a cone starts outside
    for (int i = 0; i < batch.count; ++i) {
        const Cone& cone = cones[static_cast<std::size_t>(i)];
        const vec3 surface = domain.to_linear(cone.position);
        set_start(batch, i, domain, surface, cone.normal, offset, knobs_.own_surface);
        if (domain.plain() && !domain.inside({batch.x[i], batch.y[i], batch.z[i]})) batch.merged = true;
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
    const ConeCounts done = march_cones(hierarchies_->pyramid(0), hierarchies_->air(0), schedules_[0][0].steps,
                                        static_cast<float>(knobs_.cut_off), batch);
    Counts counts;
    counts.cones = cones.size(), counts.cone_steps = done.steps, counts.voxel_fetches = done.fetches;
    return counts;
}

/// The start lies off the surface by voxels of hierarchy `from`.
ConeCaster::Start ConeCaster::start_of(const Cone& cone, int from) const {
    thread_local ConeBatch scratch;
    const Pyramid& own = hierarchies_->pyramid(from);
    const vec3 surface = own.domain.to_linear(own.pose.to_body(cone.position)), normal = own.pose.direction_to_body(cone.normal);
    set_start(scratch, 0, own.domain, surface, normal, static_cast<float>(knobs_.normal_offset), true);
    const vec3 start(scratch.x[0], scratch.y[0], scratch.z[0]);
    return {own.pose.to_world(own.domain.from_linear(start)), cone.direction};
}

Counts ConeCaster::cast_through(int part, std::uint32_t owner, std::span<const Cone> cones, std::span<const std::size_t> chosen,
                                ConeBatch& batch) const {
    const Pyramid& pyramid = hierarchies_->pyramid(part);
    const Domain& domain = pyramid.domain;
    const bool own = pyramid.pose.body == owner;
    const int from = own ? part : hierarchies_->first_of(owner);
    batch.count = static_cast<int>(chosen.size());
    batch.limited = any_ends(cones);
    batch.merged = true;
    for (int i = 0; i < batch.count; ++i) {
        const Cone& cone = cones[chosen[static_cast<std::size_t>(i)]];
        Start start = start_of(cone, from);
        batch.limit[i] = cone.distance;
        if (std::isfinite(cone.distance)) {
            const vec3 to_light = cone.position + cone.direction * cone.distance - start.position;
            const float distance = glm::length(to_light);
            if (distance > 0.0f) start.direction = to_light / distance;
            batch.limit[i] = distance / domain.voxel_size - 1.0f;
        }
        const vec3 normal = pyramid.pose.direction_to_body(cone.normal);
        const vec3 at = domain.to_linear(pyramid.pose.to_body(own ? cone.position : start.position));
        set_start(batch, i, domain, at, normal, own ? static_cast<float>(knobs_.normal_offset) : 0.0f,
                  !own || knobs_.own_surface);
        set_direction(batch, i, pyramid.pose.direction_to_body(start.direction));
    }
    const ConeCounts done =
        march_cones(pyramid, hierarchies_->air(part), schedule(part, from), static_cast<float>(knobs_.cut_off), batch);
    Counts counts;
    counts.cone_steps = done.steps, counts.voxel_fetches = done.fetches;
    return counts;
}

Counts ShadowCones::open(std::span<const ConeCaster::Cone> cones, std::span<float> share) const {
    thread_local ConeBatch batch;
    const Counts counts = caster_.cast(cones, batch);
    for (std::size_t i = 0; i < cones.size(); ++i) share[i] = batch.open[i];
    return counts;
}

}  // namespace interreflect
