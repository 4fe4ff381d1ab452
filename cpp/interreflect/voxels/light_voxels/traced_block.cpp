#include "voxels/light_voxels/traced_block.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "math/parallel.h"
#include "math/sampling.h"
#include "shading/emitter_batch.h"

namespace interreflect {

TracedBlock::TracedBlock(const LightingTask& task, bool both_sides)
    : lights_(task.lights),
      intersector_(task.intersector),
      grid_(*task.voxels),
      sides_(both_sides ? 2 : 1),
      shifts_{shift_of(task.seed, 0), shift_of(task.seed, 1)} {}

void TracedBlock::begin(std::size_t begin, std::size_t end) {
    first_ = begin;
    count_ = end - begin;
    irradiance_[0].fill(vec3(0));
    irradiance_[1].fill(vec3(0));
}

void TracedBlock::extended(int samples) {
    for (int s = 0; s < samples; ++s) {
        if (lights_.has_emitters()) emitters(s, samples);
        if (lights_.has_environment()) environment(s, samples);
    }
}

/// Queues a ray towards a light that would bring `irradiance` to a surface facing it; nothing where the side that faces it is
/// not lit.
[[gnu::always_inline]] inline void TracedBlock::queue(std::size_t k, unsigned side, const vec3& direction, float distance,
                                                      const vec3& irradiance) {
    const VoxelPoint& point = at(k, side);
    const float cosine = glm::dot(point.normal, direction);
    if (!(cosine > 0.0f) || point.reflects == 0 || !(max_component(irradiance) > 0.0f)) return;
    // Rays end short of an emitter by more than rounding and the offset move either end: it must not shadow its own light.
    batch_.rays[batch_.count] = {point.position + point.normal * point.offset, 0.0f, direction,
                                 distance * 0.9999f - 2.0f * point.offset};
    batch_.irradiance[batch_.count] = irradiance * cosine;
    batch_.target[batch_.count++] = static_cast<std::uint32_t>(2 * k) + side;
}

void TracedBlock::trace() {
    if (oneapi::tbb::is_current_task_group_canceling()) throw Cancelled();  // thousands of samples take long
    // Also towards the sun: starts that lie a voxel apart and more make packets no faster.
    const std::size_t count = std::exchange(batch_.count, 0);
    intersector_.occluded_incoherent({batch_.rays.data(), count}, {batch_.blocked.data(), count});
    for (std::size_t i = 0; i < count; ++i)
        if (batch_.blocked[i] == 0) irradiance_[batch_.target[i] & 1U][batch_.target[i] >> 1U] += batch_.irradiance[i];
    rays_ += count;
}

void TracedBlock::delta(int light) {
    const bool parallel = lights_.delta_is_directional(light);
    LightSampler::Delta d = lights_.delta(light, vec3(0));
    for (std::size_t k = 0; k < count_; ++k)
        for (unsigned side = 0; side < sides_; ++side) {
            if (!parallel) d = lights_.delta(light, at(k, side).position);
            queue(k, side, d.direction, d.distance, d.irradiance);
        }
    trace();
}

void TracedBlock::emitters(int s, int samples) {
    const float share = 1.0f / static_cast<float>(samples);
    EmitterBatch batch;
    for (unsigned side = 0; side < sides_; ++side)
        for (std::size_t begin = 0; begin < count_; begin += EmitterBatch::width) {
            const std::size_t end = std::min(begin + EmitterBatch::width, count_);
            batch.count = 0;
            for (std::size_t k = begin; k < end; ++k) {
                const vec3 u = samples_of(k, 0).at(s, samples);
                batch.add(at(k, side).position, u.x, {u.y, u.z});
            }
            sample_emitters(lights_, batch);
            for (std::size_t k = begin; k < end; ++k) {
                const LightDirection& light = batch.light[k - begin];
                if (light.pdf > 0.0f) queue(k, side, light.direction, light.distance, light.radiance * (share / light.pdf));
            }
        }
    trace();
}

void TracedBlock::environment(int s, int samples) {
    if (lights_.environment_is_constant())
        constant_environment(s, samples);
    else
        image_environment(s, samples);
    trace();
}

/// Directions by cosine.
void TracedBlock::constant_environment(int s, int samples) {
    const vec3 irradiance = lights_.environment({0, 0, 1}) * (pi / static_cast<float>(samples));
    for (std::size_t k = 0; k < count_; ++k) {
        const vec3 u = samples_of(k, 1).at(s, samples);
        const vec3 local = cosine_hemisphere({u.x, u.y});
        for (unsigned side = 0; side < sides_ && local.z > 0.0f; ++side)
            queue(k, side, Frame(at(k, side).normal).to_world(local), std::numeric_limits<float>::infinity(),
                  irradiance / local.z);
    }
}

/// Directions by luminance, over the whole sphere.
void TracedBlock::image_environment(int s, int samples) {
    const float share = 1.0f / static_cast<float>(samples);
    for (std::size_t k = 0; k < count_; ++k) {
        const vec3 u = samples_of(k, 1).at(s, samples);
        const auto light = lights_.sample_environment({u.x, u.y});
        for (unsigned side = 0; side < sides_ && light.pdf > 0.0f; ++side)
            queue(k, side, light.direction, light.distance, light.radiance * (share / light.pdf));
    }
}

LitVoxels light_blocks(const LightingTask& task, bool both_sides, int samples, const std::function<void(TracedBlock&)>& deltas) {
    const VoxelGrid& grid = *task.voxels;
    LitVoxels lit;
    lit.grid = task.voxels;
    lit.radiance = Buffer<vec3>(grid.size());
    if (both_sides) lit.back = Buffer<vec3>(grid.size());
    std::atomic<std::uint64_t> rays{0};
    parallel_blocks(grid.size(), TracedBlock::capacity, [&](std::size_t begin, std::size_t end) {
        TracedBlock block(task, both_sides);
        block.begin(begin, end);
        deltas(block);
        block.extended(samples);
        for (std::size_t k = 0; k < end - begin; ++k) {
            const vec3 reflectance = grid.albedo[begin + k] * (1.0f / pi);
            lit.radiance[begin + k] = reflectance * block.irradiance(0, k);
            if (both_sides) lit.back[begin + k] = reflectance * block.irradiance(1, k);
        }
        rays += block.rays();
    });
    lit.counts.shadow_rays = rays;
    lit.counts.voxels = grid.size();
    return lit;
}

}  // namespace interreflect
