#include "voxels/light_voxels/traced_lighting.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

#include "math/parallel.h"
#include "math/rng.h"
#include "math/sampling.h"
#include "shading/emitter_batch.h"

namespace interreflect {
namespace {

constexpr std::size_t voxels_of_block = 512;

/// Voxels in bricks of 8 x 8 x 8, so that neighbouring rays start near each other.
std::vector<std::uint32_t> brick_order(const VoxelGrid& grid) {
    const ivec3 bricks = (grid.domain.cells + 7) / 8;
    std::vector<std::uint32_t> key(grid.size()), first(static_cast<std::size_t>(bricks.x) * bricks.y * bricks.z + 1);
    parallel_blocks(grid.size(), 8192, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const ivec3 at = grid.domain.coordinates(grid.cell[i]) / 8;
            key[i] = static_cast<std::uint32_t>(at.x + bricks.x * (at.y + bricks.y * at.z));
        }
    });
    for (const auto k : key) ++first[k + 1];
    for (std::size_t k = 1; k < first.size(); ++k) first[k] += first[k - 1];
    std::vector<std::uint32_t> order(grid.size());
    for (std::size_t i = 0; i < key.size(); ++i) order[first[key[i]]++] = static_cast<std::uint32_t>(i);
    return order;
}

/// Unit square samples of a voxel: a Kronecker sequence over its coordinates, so that neighbours look in different directions
/// (they are seen together, by cones), shifted by the seed; over its own samples, a rank-1 sequence again.
struct VoxelSamples {
    vec3 start{0};

    VoxelSamples(const ivec3& at, std::uint32_t seed, std::uint32_t purpose) {
        const std::uint32_t key = hash_combine(seed, purpose);
        for (int k = 0; k < 3; ++k) {
            // Roots of x^(d+1) = x + 1 give the steps [Roberts 2018]; nine for three coordinates by three numbers.
            static constexpr std::array<std::array<double, 3>, 3> steps{{{0.8191725134, 0.6710436067, 0.5497004779},
                                                                         {0.6180339887, 0.7320508076, 0.2360679775},
                                                                         {0.4142135624, 0.6457513111, 0.8284271247}}};
            const double walk = steps[k][0] * at.x + steps[k][1] * at.y + steps[k][2] * at.z;
            start[k] = static_cast<float>(walk - std::floor(walk)) + unit_float(hash_combine(key, static_cast<std::uint32_t>(k)));
        }
    }
    /// Sample i of n: stratified in x, a low-discrepancy set in all three.
    vec3 at(int i, int n) const {
        const auto k = static_cast<float>(i);
        return glm::fract(start + vec3(k / static_cast<float>(n), k * 0.7548776662f, k * 0.5698402910f)) * (1.0f - 0x1p-24f);
    }
};

/// A shadow ray on its way, and the irradiance it brings where nothing is in between.
struct Batch {
    std::vector<Ray> rays;
    std::vector<vec3> irradiance;
    std::vector<std::uint32_t> target;
    std::vector<std::uint8_t> blocked;

    void clear() {
        rays.clear();
        irradiance.clear();
        target.clear();
    }
};

class Lighting {
  public:
    Lighting(const TracedLighting& technique, const LightSampler& lights, const Intersector& intersector, const VoxelGrid& grid,
             std::uint32_t seed)
        : technique_(technique), lights_(lights), intersector_(intersector), grid_(grid), seed_(seed) {}

    /// Lights the voxels of `order`; irradiance of the front, then of the back.
    void block(std::span<const std::uint32_t> order, LitVoxels& lit) {
        order_ = order;
        irradiance_[0].assign(order.size(), vec3(0));
        irradiance_[1].assign(order.size(), vec3(0));
        for (int i = 0; i < lights_.delta_count(); ++i) delta(i);
        for (int s = 0; s < technique_.samples; ++s) {
            if (lights_.has_emitters()) emitters(s);
            if (lights_.has_environment()) environment(s);
        }
        for (std::size_t k = 0; k < order.size(); ++k) {
            const std::uint32_t voxel = order[k];
            const vec3 reflectance = grid_.albedo[voxel] * (1.0f / pi);
            lit.radiance[voxel] = reflectance * irradiance_[0][k];
            if (technique_.both_sides) lit.back[voxel] = reflectance * irradiance_[1][k];
        }
    }
    std::uint64_t rays() const { return rays_; }

  private:
    /// Queues a ray towards a light that would bring `irradiance` to a surface facing it; nothing where the side that faces it is
    /// not lit.
    void queue(std::size_t k, unsigned side, const vec3& direction, float distance, const vec3& irradiance) {
        const VoxelPoint& point = at(k, side);
        const float cosine = glm::dot(point.normal, direction);
        if (!(cosine > 0.0f) || point.reflects == 0 || !(max_component(irradiance) > 0.0f)) return;
        // Rays end short of an emitter by more than rounding and the offset move either end: it must not shadow its own light.
        batch_.rays.push_back(
            {point.position + point.normal * point.offset, 0.0f, direction, distance * 0.9999f - 2.0f * point.offset});
        batch_.irradiance.push_back(irradiance * cosine);
        batch_.target.push_back(static_cast<std::uint32_t>(2 * k) + side);
    }
    const VoxelPoint& at(std::size_t k, unsigned side) const { return (side == 0 ? grid_.points : grid_.backs)[order_[k]]; }
    unsigned sides() const { return technique_.both_sides ? 2 : 1; }
    void trace(bool coherent) {
        if (oneapi::tbb::is_current_task_group_canceling()) throw Cancelled();  // thousands of samples take long
        batch_.blocked.resize(batch_.rays.size());
        if (coherent)
            intersector_.occluded_coherent(batch_.rays, batch_.blocked);
        else
            intersector_.occluded_incoherent(batch_.rays, batch_.blocked);
        for (std::size_t i = 0; i < batch_.rays.size(); ++i)
            if (batch_.blocked[i] == 0) irradiance_[batch_.target[i] & 1U][batch_.target[i] >> 1U] += batch_.irradiance[i];
        rays_ += batch_.rays.size();
        batch_.clear();
    }

    void delta(int light) {
        for (std::size_t k = 0; k < order_.size(); ++k) {
            for (unsigned side = 0; side < sides(); ++side) {
                const auto d = lights_.delta(light, at(k, side).position);
                queue(k, side, d.direction, d.distance, d.irradiance);
            }
        }
        trace(true);
    }
    VoxelSamples samples_of(std::size_t k, std::uint32_t purpose) const {
        return {grid_.domain.coordinates(grid_.cell[order_[k]]), seed_, purpose};
    }
    void emitters(int s) {
        const float share = 1.0f / static_cast<float>(technique_.samples);
        EmitterBatch batch;
        for (unsigned side = 0; side < sides(); ++side)
            for (std::size_t begin = 0; begin < order_.size(); begin += EmitterBatch::width) {
                const std::size_t end = std::min(begin + EmitterBatch::width, order_.size());
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
        trace(false);
    }
    /// Constant: directions by cosine. An image: directions by its luminance, over the whole sphere.
    void environment(int s) {
        const float share = 1.0f / static_cast<float>(technique_.samples);
        for (std::size_t k = 0; k < order_.size(); ++k) {
            const vec3 u = samples_of(k, 1).at(s, technique_.samples);
            if (!lights_.environment_is_constant()) {
                const auto light = lights_.sample_environment({u.x, u.y});
                for (unsigned side = 0; side < sides() && light.pdf > 0.0f; ++side)
                    queue(k, side, light.direction, light.distance, light.radiance * (share / light.pdf));
                continue;
            }
            const vec3 local = cosine_hemisphere({u.x, u.y});
            for (unsigned side = 0; side < sides() && local.z > 0.0f; ++side) {
                const vec3 away = Frame(at(k, side).normal).to_world(local);
                queue(k, side, away, std::numeric_limits<float>::infinity(), lights_.environment(away) * (pi * share / local.z));
            }
        }
        trace(false);
    }

    const TracedLighting& technique_;
    const LightSampler& lights_;
    const Intersector& intersector_;
    const VoxelGrid& grid_;
    std::uint32_t seed_;
    std::span<const std::uint32_t> order_;
    std::vector<vec3> irradiance_[2];
    Batch batch_;
    std::uint64_t rays_ = 0;
};

}  // namespace

LitVoxels light_voxels(const TracedLighting& technique, const LightSampler& lights, const Intersector& intersector,
                       std::shared_ptr<const VoxelGrid> voxels, std::uint32_t seed) {
    LitVoxels lit;
    lit.radiance = Buffer<vec3>(voxels->size());
    if (technique.both_sides) lit.back = Buffer<vec3>(voxels->size());
    const auto order = brick_order(*voxels);
    std::atomic<std::uint64_t> rays{0};
    parallel_blocks(order.size(), voxels_of_block, [&](std::size_t begin, std::size_t end) {
        Lighting lighting(technique, lights, intersector, *voxels, seed);
        lighting.block(std::span(order).subspan(begin, end - begin), lit);
        rays += lighting.rays();
    });
    lit.counts.shadow_rays = rays;
    lit.counts.voxels = voxels->size();
    lit.grid = std::move(voxels);
    return lit;
}

}  // namespace interreflect
