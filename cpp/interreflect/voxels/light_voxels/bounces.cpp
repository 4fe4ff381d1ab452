#include "voxels/light_voxels/bounces.h"

#include <array>
#include <stdexcept>
#include <vector>

#include "math/parallel.h"
#include "voxels/march/cone_caster.h"
#include "voxels/march/cone_set.h"

namespace interreflect {
namespace {

constexpr std::size_t capacity = ConeBatch::capacity;

/// Adds to voxels [begin, end) what one of their sides reflects of the last frame's light.
Counts gather(const ConeCaster& caster, const ConeSet& set, float scale, const VoxelGrid& grid, const Buffer<VoxelPoint>& points,
              std::size_t begin, std::size_t end, Buffer<vec3>& radiance) {
    thread_local ConeBatch batch;
    thread_local std::vector<ConeCaster::Cone> cones;
    std::array<std::size_t, capacity> target;
    Counts counts;
    std::size_t count = 0;
    cones.clear();
    for (std::size_t i = begin; i < end; ++i) {
        if (points[i].reflects == 0 || !(max_component(grid.albedo[i]) > 0.0f)) continue;
        target[count++] = i;
        cones.push_back({points[i].position, points[i].normal, {}});
    }
    for (const auto& cone : set.cones) {
        for (std::size_t k = 0; k < count; ++k) cones[k].direction = Frame(cones[k].normal).to_world(cone.direction);
        counts += caster.cast(cones, batch);
        for (std::size_t k = 0; k < count; ++k)
            radiance[target[k]] += grid.albedo[target[k]] * vec3(batch.r[k], batch.g[k], batch.b[k]) * (cone.weight * scale);
    }
    return counts;
}

}  // namespace

LitVoxels light_voxels(const Bounces& technique, const LightingTask& task) {
    LitVoxels lit = std::visit([&](const auto& own) { return light_voxels(own, task); }, technique.light_voxels);
    if (task.last.pyramid == nullptr) {
        if (task.last.lit != nullptr) throw std::invalid_argument("Bounces: the history must be the last frame's pyramid");
        return lit;
    }
    const Pyramid& last = *task.last.pyramid;
    const VoxelGrid& grid = *task.voxels;
    const ConeSet set = cosine_cones(technique.cones, 0.0f);
    const Pyramid* const pyramids[] = {&last};
    const ConeCaster caster(pyramids, technique, set.half_angle);
    std::vector<Counts> counts((grid.size() + capacity - 1) / capacity);
    parallel_blocks(grid.size(), capacity, [&](std::size_t begin, std::size_t end) {
        Counts& done = counts[begin / capacity];
        done += gather(caster, set, last.scale, grid, grid.points, begin, end, lit.radiance);
        if (!lit.back.empty()) done += gather(caster, set, last.scale, grid, grid.backs, begin, end, lit.back);
    });
    for (const Counts& one : counts) lit.counts += one;
    return lit;
}

}  // namespace interreflect
