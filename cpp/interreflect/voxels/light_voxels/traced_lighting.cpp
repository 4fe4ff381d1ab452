#include "voxels/light_voxels/traced_lighting.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "math/parallel.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "shading/emitter_batch.h"

namespace interreflect {
namespace {

constexpr std::size_t voxels_of_block = 512;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// A fraction of 2^32: sums wrap around as a Kronecker sequence asks for.
constexpr std::uint32_t fraction(double value) { return static_cast<std::uint32_t>(value * 0x1p32); }

/// Three coordinates of a unit cube, as fractions of 2^32.
using CubePoint = std::array<std::uint32_t, 3>;

/// Where the samples of all voxels begin.
CubePoint shift_of(std::uint32_t seed, std::uint32_t purpose) {
    const std::uint32_t key = hash_combine(seed, purpose);
    return {hash_combine(key, 0), hash_combine(key, 1), hash_combine(key, 2)};
}

/// Unit cube samples of a voxel: a Kronecker sequence over its coordinates, so that neighbours look in different directions
/// (they are seen together, by cones), shifted by the seed; over its own samples, a rank-1 sequence again.
struct VoxelSamples {
    CubePoint start;

    VoxelSamples(const ivec3& at, const CubePoint& shift) {
        // Roots of x^(d+1) = x + 1 give the steps [Roberts 2018]; nine for three coordinates by three numbers.
        static constexpr std::uint32_t steps[3][3] = {{fraction(0.8191725134), fraction(0.6710436067), fraction(0.5497004779)},
                                                      {fraction(0.6180339887), fraction(0.7320508076), fraction(0.2360679775)},
                                                      {fraction(0.4142135624), fraction(0.6457513111), fraction(0.8284271247)}};
        const auto x = static_cast<std::uint32_t>(at.x), y = static_cast<std::uint32_t>(at.y),
                   z = static_cast<std::uint32_t>(at.z);
        for (std::size_t k = 0; k < 3; ++k) start[k] = steps[k][0] * x + steps[k][1] * y + steps[k][2] * z + shift[k];
    }
    /// Sample i of n: stratified in x, a low-discrepancy set in all three.
    vec3 at(int i, int n) const {
        const auto k = static_cast<std::uint32_t>(i);
        const auto stratum = static_cast<std::uint32_t>((static_cast<std::uint64_t>(k) << 32) / static_cast<std::uint32_t>(n));
        return {unit_float(start[0] + stratum), unit_float(start[1] + k * fraction(0.7548776662)),
                unit_float(start[2] + k * fraction(0.5698402910))};
    }
};

/// Shadow rays on their way, and the irradiance they bring where nothing is in between.
struct Batch {
    std::size_t count = 0;
    std::array<Ray, 2 * voxels_of_block> rays;
    std::array<vec3, 2 * voxels_of_block> irradiance;
    std::array<std::uint32_t, 2 * voxels_of_block> target;
    std::array<std::uint8_t, 2 * voxels_of_block> blocked;
};

class Lighting {
  public:
    Lighting(const TracedLighting& technique, const LightSampler& lights, const Intersector& intersector, const VoxelGrid& grid,
             std::uint32_t seed)
        : technique_(technique),
          lights_(lights),
          intersector_(intersector),
          grid_(grid),
          shifts_{shift_of(seed, 0), shift_of(seed, 1)} {}

    /// Lights voxels [begin, end).
    void block(std::size_t begin, std::size_t end, LitVoxels& lit) {
        first_ = begin;
        count_ = end - begin;
        irradiance_[0].fill(vec3(0));
        irradiance_[1].fill(vec3(0));
        for (int i = 0; i < lights_.delta_count(); ++i) delta(i);
        for (int s = 0; s < technique_.samples; ++s) {
            if (lights_.has_emitters()) emitters(s);
            if (lights_.has_environment()) environment(s);
        }
        for (std::size_t k = 0; k < count_; ++k) {
            const vec3 reflectance = grid_.albedo[begin + k] * (1.0f / pi);
            lit.radiance[begin + k] = reflectance * irradiance_[0][k];
            if (technique_.both_sides) lit.back[begin + k] = reflectance * irradiance_[1][k];
        }
    }
    std::uint64_t rays() const { return rays_; }

  private:
    /// Queues a ray towards a light that would bring `irradiance` to a surface facing it; nothing where the side that faces it is
    /// not lit.
    [[gnu::always_inline]] void queue(std::size_t k, unsigned side, const vec3& direction, float distance,
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
    const VoxelPoint& at(std::size_t k, unsigned side) const { return (side == 0 ? grid_.points : grid_.backs)[first_ + k]; }
    unsigned sides() const { return technique_.both_sides ? 2 : 1; }
    void trace() {
        if (oneapi::tbb::is_current_task_group_canceling()) throw Cancelled();  // thousands of samples take long
        // Also towards the sun: starts that lie a voxel apart and more make packets no faster.
        const std::size_t count = std::exchange(batch_.count, 0);
        intersector_.occluded_incoherent({batch_.rays.data(), count}, {batch_.blocked.data(), count});
        for (std::size_t i = 0; i < count; ++i)
            if (batch_.blocked[i] == 0) irradiance_[batch_.target[i] & 1U][batch_.target[i] >> 1U] += batch_.irradiance[i];
        rays_ += count;
    }

    void delta(int light) {
        const bool parallel = lights_.delta_is_directional(light);
        LightSampler::Delta d = lights_.delta(light, vec3(0));
        for (std::size_t k = 0; k < count_; ++k)
            for (unsigned side = 0; side < sides(); ++side) {
                if (!parallel) d = lights_.delta(light, at(k, side).position);
                queue(k, side, d.direction, d.distance, d.irradiance);
            }
        trace();
    }
    VoxelSamples samples_of(std::size_t k, std::uint32_t purpose) const {
        return {grid_.domain.coordinates(grid_.cell[first_ + k]), shifts_[purpose]};
    }
    void emitters(int s) {
        const float share = 1.0f / static_cast<float>(technique_.samples);
        EmitterBatch batch;
        for (unsigned side = 0; side < sides(); ++side)
            for (std::size_t begin = 0; begin < count_; begin += EmitterBatch::width) {
                const std::size_t end = std::min(begin + EmitterBatch::width, count_);
                batch.count = 0;
                for (std::size_t k = begin; k < end; ++k) {
                    const vec3 u = samples_of(k, 0).at(s, technique_.samples);
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
    void environment(int s) {
        if (lights_.environment_is_constant())
            constant_environment(s);
        else
            image_environment(s);
        trace();
    }
    /// Directions by cosine.
    void constant_environment(int s) {
        const vec3 irradiance = lights_.environment({0, 0, 1}) * (pi / static_cast<float>(technique_.samples));
        for (std::size_t k = 0; k < count_; ++k) {
            const vec3 u = samples_of(k, 1).at(s, technique_.samples);
            const vec3 local = cosine_hemisphere({u.x, u.y});
            for (unsigned side = 0; side < sides() && local.z > 0.0f; ++side)
                queue(k, side, Frame(at(k, side).normal).to_world(local), infinity, irradiance / local.z);
        }
    }
    /// Directions by luminance, over the whole sphere.
    void image_environment(int s) {
        const float share = 1.0f / static_cast<float>(technique_.samples);
        for (std::size_t k = 0; k < count_; ++k) {
            const vec3 u = samples_of(k, 1).at(s, technique_.samples);
            const auto light = lights_.sample_environment({u.x, u.y});
            for (unsigned side = 0; side < sides() && light.pdf > 0.0f; ++side)
                queue(k, side, light.direction, light.distance, light.radiance * (share / light.pdf));
        }
    }

    const TracedLighting& technique_;
    const LightSampler& lights_;
    const Intersector& intersector_;
    const VoxelGrid& grid_;
    CubePoint shifts_[2];  // of the samples of emitters, and of the environment
    std::size_t first_ = 0, count_ = 0;
    std::array<vec3, voxels_of_block> irradiance_[2];  // of the fronts, and of the backs
    Batch batch_;
    std::uint64_t rays_ = 0;
};

}  // namespace

LitVoxels light_voxels(const TracedLighting& technique, const LightSampler& lights, const Intersector& intersector,
                       std::shared_ptr<const VoxelGrid> voxels, std::uint32_t seed) {
    LitVoxels lit;
    lit.radiance = Buffer<vec3>(voxels->size());
    if (technique.both_sides) lit.back = Buffer<vec3>(voxels->size());
    std::atomic<std::uint64_t> rays{0};
    parallel_blocks(voxels->size(), voxels_of_block, [&](std::size_t begin, std::size_t end) {
        Lighting lighting(technique, lights, intersector, *voxels, seed);
        lighting.block(begin, end, lit);
        rays += lighting.rays();
    });
    lit.counts.shadow_rays = rays;
    lit.counts.voxels = voxels->size();
    lit.grid = std::move(voxels);
    return lit;
}

}  // namespace interreflect
