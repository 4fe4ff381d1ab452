#include "voxels/light_voxels/shadow_map_injection.h"

#include <atomic>
#include <vector>

#include "math/parallel.h"
#include "visibility/depth_map.h"
#include "voxels/light_voxels/traced_block.h"

namespace interreflect {
namespace {

// Texels: a surface that bends within its voxel departs from its tangent plane by less (ShadowMap's default and reason).
constexpr float bias = 1.0f;

/// A bit for every cell of a domain, set from all threads.
class CellBits {
  public:
    explicit CellBits(const VoxelGrid& grid) : grid_(grid), words_((grid.domain.cell_count() + 31) / 32) {}

    /// The cells just before and just behind a hit of a ray: rounding may have put it across a voxel's face.
    void set_around(const vec3& hit, const vec3& nudge) {
        std::uint32_t before = 0, behind = 0;
        const bool inside = find(hit - nudge, before), still = find(hit + nudge, behind);
        if (inside) set(before);
        if (still && !(inside && before == behind)) set(behind);
    }
    bool has(std::uint32_t cell) const { return (words_[cell >> 5U].load(std::memory_order_relaxed) >> (cell & 31U) & 1U) != 0; }

  private:
    /// Domain::locate, without its call where there is nothing to warp: hundreds of thousands of texels ask.
    bool find(const vec3& position, std::uint32_t& cell) const {
        const Domain& domain = grid_.domain;
        const vec3 place = grid_.pose.to_body(position);
        if (!plain_) return domain.locate(place, cell);
        const vec3 voxels = domain.to_linear(place);
        if (!domain.inside(voxels)) return false;
        cell = domain.cell(ivec3(voxels));
        return true;
    }
    void set(std::uint32_t cell) {
        const std::uint32_t bit = 1U << (cell & 31U);
        std::atomic<std::uint32_t>& word = words_[cell >> 5U];
        if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
    }

    const VoxelGrid& grid_;
    bool plain_ = grid_.domain.plain();
    std::vector<std::atomic<std::uint32_t>> words_;
};

/// Brings every texel's hit to its cell.
void mark(const DepthMap& map, const Domain& domain, CellBits& cells) {
    const float nudge = 1e-2f * domain.voxel_size;  // far above a hit's rounding, far below a voxel
    const LightView& view = map.view;
    parallel_blocks(static_cast<std::size_t>(view.size), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (int x = 0; x < view.size; ++x) {
                const float depth = map.depth[y * static_cast<std::size_t>(view.size) + static_cast<std::size_t>(x)];
                if (!std::isfinite(depth)) continue;
                const Ray ray = view.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                cells.set_around(ray.origin + ray.direction * depth, ray.direction * nudge);
            }
    });
}

/// One light: what it meets, and how far away.
struct InjectedLight {
    DepthMaps maps;
    CellBits cells;

    InjectedLight(const LightingTask& task, int number, int size)
        : maps(views_of_light(task.scene, number, size), task.intersector), cells(*task.voxels) {
        for (const DepthMap& map : maps.maps) mark(map, task.voxels->domain, cells);
    }
};

/// Adds what one light brings to one side of a block of voxels.
void add(const ShadowMapInjection& technique, const LightingTask& task, int number, const InjectedLight& light, unsigned side,
         TracedBlock& block) {
    const VoxelGrid& grid = *task.voxels;
    for (std::size_t k = 0; k < block.count(); ++k) {
        const std::size_t voxel = block.first() + k;
        const VoxelPoint& point = (side == 0 ? grid.points : grid.backs)[voxel];
        if (point.reflects == 0 || !light.cells.has(grid.cell[voxel])) continue;
        const LightSampler::Delta arriving = task.lights.delta(number, point.position);
        const float cosine = glm::dot(point.normal, arriving.direction);
        if (!(cosine > 0.0f) || !(max_component(arriving.irradiance) > 0.0f)) continue;
        if (technique.radiance == "base_colour")
            block.set(side, k, vec3(pi));  // albedo / pi times this; the paper's colour does not grow with the number of lights
        else
            block.add(side, k, arriving.irradiance * (cosine * light.maps.lit(point.position, point.normal, bias, point.offset)));
    }
}

}  // namespace

LitVoxels light_voxels(const ShadowMapInjection& technique, const LightingTask& task) {
    std::vector<InjectedLight> lights;
    std::uint64_t texels = 0;
    if (task.voxels->size() > 0)
        for (int i = 0; i < task.lights.delta_count(); ++i) {
            lights.emplace_back(task, i, technique.size);
            texels += lights.back().maps.texels();
        }
    LitVoxels lit = light_blocks(task, technique.both_sides, technique.samples, [&](TracedBlock& block) {
        for (unsigned side = 0; side < (technique.both_sides ? 2U : 1U); ++side)
            for (std::size_t i = 0; i < lights.size(); ++i) add(technique, task, static_cast<int>(i), lights[i], side, block);
    });
    lit.counts.rays = texels;
    return lit;
}

}  // namespace interreflect
