/// Light that shadow rays bring to a block of voxels.
#pragma once
#include <array>
#include <functional>

#include "voxels/light_voxels/lighting_task.h"
#include "voxels/light_voxels/voxel_samples.h"

namespace interreflect {

/// Irradiance of the fronts, and where asked for of the backs, of up to `capacity` voxels, at the points where they are lit.
class TracedBlock {
  public:
    static constexpr std::size_t capacity = 512;

    TracedBlock(const LightingTask& task, bool both_sides);

    /// Turns to voxels [begin, end), not lit yet.
    void begin(std::size_t begin, std::size_t end);
    /// Adds point, spot or directional light number `light`.
    void delta(int light);
    /// Adds emitters and environment by `samples` stratified samples of each.
    void extended(int samples);

    /// Light that was found otherwise.
    void add(unsigned side, std::size_t k, const vec3& irradiance) { irradiance_[side][k] += irradiance; }
    void set(unsigned side, std::size_t k, const vec3& irradiance) { irradiance_[side][k] = irradiance; }

    std::size_t first() const { return first_; }
    std::size_t count() const { return count_; }
    /// Of voxel `begin + k`; side 0: the front.
    const vec3& irradiance(unsigned side, std::size_t k) const { return irradiance_[side][k]; }
    std::uint64_t rays() const { return rays_; }

  private:
    /// Shadow rays on their way, and the irradiance they bring where nothing is in between.
    struct Batch {
        std::size_t count = 0;
        std::array<Ray, 2 * capacity> rays;
        std::array<vec3, 2 * capacity> irradiance;
        std::array<std::uint32_t, 2 * capacity> target;
        std::array<std::uint8_t, 2 * capacity> blocked;
    };

    void queue(std::size_t k, unsigned side, const vec3& direction, float distance, const vec3& irradiance);
    const VoxelPoint& at(std::size_t k, unsigned side) const { return (side == 0 ? grid_.points : grid_.backs)[first_ + k]; }
    VoxelSamples samples_of(std::size_t k, std::uint32_t purpose) const {
        return {grid_.domain.coordinates(grid_.cell[first_ + k]), shifts_[purpose]};
    }
    void trace();
    void emitters(int s, int samples);
    void environment(int s, int samples);
    void constant_environment(int s, int samples);
    void image_environment(int s, int samples);

    const LightSampler& lights_;
    const Intersector& intersector_;
    const VoxelGrid& grid_;
    unsigned sides_;
    CubePoint shifts_[2];  // of the samples of emitters, and of the environment
    std::size_t first_ = 0, count_ = 0;
    std::array<vec3, capacity> irradiance_[2];  // of the fronts, and of the backs
    Batch batch_;
    std::uint64_t rays_ = 0;
};

/// Radiance of the task's voxels, albedo / pi * irradiance: `deltas` adds that of point, spot and directional lights to a block;
/// emitters and environment come by `samples` of each.
LitVoxels light_blocks(const LightingTask& task, bool both_sides, int samples, const std::function<void(TracedBlock&)>& deltas);

}  // namespace interreflect
