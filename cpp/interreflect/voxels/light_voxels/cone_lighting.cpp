#include "voxels/light_voxels/cone_lighting.h"

#include <algorithm>
#include <array>
#include <vector>

#include "math/parallel.h"
#include "shading/emitter_batch.h"
#include "voxels/light_voxels/voxel_samples.h"
#include "voxels/march/cone_caster.h"
#include "voxels/march/cone_environment.h"
#include "voxels/march/cone_set.h"
#include "voxels/prefilter/surface_coverage.h"

namespace interreflect {
namespace {

constexpr std::size_t capacity = ConeBatch::capacity;
using Cone = ConeCaster::Cone;

/// The opacity of the voxels alone, by the paper's surface coverage.
Pyramid opacity_of(const std::shared_ptr<const VoxelGrid>& voxels) {
    LitVoxels dark;
    dark.grid = voxels;
    dark.radiance = Buffer<vec3>(voxels->size(), vec3(0));
    return prefilter(SurfaceCoverage{}, dark);
}

/// One side of a block of voxels.
class SideBlock {
  public:
    SideBlock(const ConeLighting& technique, const LightingTask& task, const ShadowCones& shadows, unsigned side)
        : technique_(technique),
          task_(task),
          shadows_(shadows),
          grid_(*task.voxels),
          side_(side),
          shift_(shift_of(task.seed, 0)) {}

    void begin(std::size_t begin, std::size_t end) {
        first_ = begin, count_ = end - begin;
        irradiance_.fill(vec3(0));
        for (std::size_t k = 0; k < count_; ++k) {
            const std::size_t i = first_ + k;
            const vec3 mean = side_ == 0 ? grid_.normal[i] : -grid_.normal[i];
            const VoxelPoint& point = (side_ == 0 ? grid_.points : grid_.backs)[i];
            normal_[k] = glm::dot(mean, mean) > 0.0f ? mean : point.normal;  // opposite sides leave no mean
            reflects_[k] = point.reflects != 0;
        }
    }
    void delta(int number) {
        for (std::size_t k = 0; k < count_; ++k) {
            const auto light = task_.lights.delta(number, grid_.position[first_ + k]);
            queue(k, light.direction, light.distance, light.irradiance);
        }
        march();
    }
    void emitters(int s) {
        const float share = 1.0f / static_cast<float>(technique_.samples);
        EmitterBatch batch;
        for (std::size_t begin = 0; begin < count_; begin += EmitterBatch::width) {
            const std::size_t end = std::min(begin + EmitterBatch::width, count_);
            batch.count = 0;
            for (std::size_t k = begin; k < end; ++k) {
                const VoxelSamples samples(grid_.domain.coordinates(grid_.cell[first_ + k]), shift_);
                const vec3 u = samples.at(s, technique_.samples);
                batch.add(grid_.position[first_ + k], u.x, {u.y, u.z});
            }
            sample_emitters(task_.lights, batch);
            for (std::size_t k = begin; k < end; ++k) {
                const LightDirection& light = batch.light[k - begin];
                if (light.pdf > 0.0f) queue(k, light.direction, light.distance, light.radiance * (share / light.pdf));
            }
        }
        march();
    }
    void environment(const ConeCaster& caster, const ConeSet& set, const ConeEnvironment& environment) {
        thread_local ConeBatch batch;
        for (const auto& one : set.cones) {
            cones_.clear(), target_.clear();
            for (std::size_t k = 0; k < count_; ++k)
                if (reflects_[k]) aim(k, Frame(normal_[k]).to_world(one.direction));
            counts_ += caster.cast(cones_, batch);
            for (std::size_t i = 0; i < cones_.size(); ++i)
                irradiance_[target_[i]] += environment.mean(cones_[i].direction) * (pi * one.weight * batch.open[i]);
        }
    }
    void reflect(Buffer<vec3>& radiance) const {
        for (std::size_t k = 0; k < count_; ++k) radiance[first_ + k] = grid_.albedo[first_ + k] * (1.0f / pi) * irradiance_[k];
    }
    const Counts& counts() const { return counts_; }

  private:
    void aim(std::size_t k, const vec3& direction, float distance = std::numeric_limits<float>::infinity()) {
        cones_.push_back({grid_.position[first_ + k], normal_[k], direction, distance, grid_.pose.body});
        target_.push_back(k);
    }
    void queue(std::size_t k, const vec3& direction, float distance, const vec3& irradiance) {
        const float cosine = glm::dot(normal_[k], direction);
        if (!(cosine > 0.0f) || !reflects_[k] || !(max_component(irradiance) > 0.0f)) return;
        light_[cones_.size()] = irradiance * cosine;
        aim(k, direction, distance);
    }
    void march() {
        if (oneapi::tbb::is_current_task_group_canceling()) throw Cancelled();
        std::array<float, capacity> open;
        counts_ += shadows_.open(cones_, std::span<float>(open).first(cones_.size()));
        for (std::size_t i = 0; i < cones_.size(); ++i) irradiance_[target_[i]] += light_[i] * open[i];
        cones_.clear(), target_.clear();
    }

    const ConeLighting& technique_;
    const LightingTask& task_;
    const ShadowCones& shadows_;
    const VoxelGrid& grid_;
    unsigned side_;
    CubePoint shift_;
    std::size_t first_ = 0, count_ = 0;
    std::array<vec3, capacity> normal_, irradiance_, light_;
    std::array<bool, capacity> reflects_;
    std::vector<Cone> cones_;
    std::vector<std::size_t> target_;
    Counts counts_;
};

}  // namespace

LitVoxels light_voxels(const ConeLighting& technique, const LightingTask& task) {
    const VoxelGrid& grid = *task.voxels;
    std::vector<Pyramid> opacities;
    opacities.reserve(1 + task.others.size());
    opacities.push_back(opacity_of(task.occluders));
    for (const auto& other : task.others) opacities.push_back(opacity_of(other));
    std::vector<const Pyramid*> pyramids;
    pyramids.reserve(opacities.size());
    for (const Pyramid& opacity : opacities) pyramids.push_back(&opacity);
    const ShadowCones shadows(pyramids, technique, static_cast<float>(technique.half_angle) * degrees_to_radians);
    const ConeSet sky = cosine_cones(technique.sky_cones, 0.0f);
    const ConeCaster sky_caster(pyramids, technique, sky.half_angle);
    const ConeEnvironment environment(task.scene, sky.half_angle);

    LitVoxels lit;
    lit.grid = task.voxels;
    lit.radiance = Buffer<vec3>(grid.size());
    if (technique.both_sides) lit.back = Buffer<vec3>(grid.size());
    std::vector<Counts> counts((grid.size() + capacity - 1) / capacity);
    parallel_blocks(grid.size(), capacity, [&](std::size_t begin, std::size_t end) {
        for (unsigned side = 0; side < (technique.both_sides ? 2U : 1U); ++side) {
            SideBlock block(technique, task, shadows, side);
            block.begin(begin, end);
            for (int i = 0; i < task.lights.delta_count(); ++i) block.delta(i);
            for (int s = 0; s < technique.samples && task.lights.has_emitters(); ++s) block.emitters(s);
            if (environment.present()) block.environment(sky_caster, sky, environment);
            block.reflect(side == 0 ? lit.radiance : lit.back);
            counts[begin / capacity] += block.counts();
        }
    });
    for (const Counts& one : counts) lit.counts += one;
    lit.counts.voxels = grid.size();
    return lit;
}

}  // namespace interreflect
