#include "voxels/light_voxels/blend_history.h"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <vector>

#include "math/parallel.h"

namespace interreflect {
namespace {

constexpr std::uint32_t none = 0xffffffff;

/// The number of each voxel in the last frame's grid; `none` where that had no voxel at its place.
std::vector<std::uint32_t> places_in(const VoxelGrid& last, const VoxelGrid& grid) {
    std::vector<std::uint32_t> place(grid.size(), none);
    parallel_blocks(grid.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const vec3 centre = grid.domain.from_linear(grid.domain.linear_centre(grid.cell[i]));
            std::uint32_t cell = 0;
            if (!last.domain.locate(centre, cell)) continue;
            const auto* found = std::lower_bound(last.cell.begin(), last.cell.end(), cell);
            if (found != last.cell.end() && *found == cell) place[i] = static_cast<std::uint32_t>(found - last.cell.begin());
        }
    });
    return place;
}

template <class Item>
Buffer<Item> chosen_of(const Buffer<Item>& all, std::span<const std::uint32_t> chosen) {
    Buffer<Item> some(chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) some[i] = all[chosen[i]];
    return some;
}

/// A grid of some of the voxels.
std::shared_ptr<const VoxelGrid> part_of(const VoxelGrid& grid, std::span<const std::uint32_t> chosen) {
    auto part = std::make_shared<VoxelGrid>();
    part->domain = grid.domain;
    part->pose = grid.pose;
    part->cell = chosen_of(grid.cell, chosen);
    part->albedo = chosen_of(grid.albedo, chosen);
    part->normal = chosen_of(grid.normal, chosen);
    part->emission = chosen_of(grid.emission, chosen);
    part->position = chosen_of(grid.position, chosen);
    part->opacity = chosen_of(grid.opacity, chosen);
    part->area = chosen_of(grid.area, chosen);
    part->points = chosen_of(grid.points, chosen);
    part->backs = chosen_of(grid.backs, chosen);
    return part;
}

/// The voxels of one slab, and all that have no history.
std::vector<std::uint32_t> to_be_lit(const VoxelGrid& grid, std::span<const std::uint32_t> place, int slabs,
                                     std::uint32_t frame) {
    std::vector<std::uint32_t> chosen;
    const auto slab = static_cast<int>(frame % static_cast<std::uint32_t>(slabs));
    for (std::size_t i = 0; i < grid.size(); ++i)
        if (place[i] == none || grid.domain.coordinates(grid.cell[i]).z * slabs / grid.domain.cells.z == slab)
            chosen.push_back(static_cast<std::uint32_t>(i));
    return chosen;
}

/// One side: the last frame's radiance, blended with the new one of the voxels that are `chosen`. `last` may lack that side.
Buffer<vec3> blend(float weight, std::span<const std::uint32_t> place, const Buffer<vec3>& last,
                   std::span<const std::uint32_t> chosen, const Buffer<vec3>& fresh) {
    Buffer<vec3> radiance(place.size());
    for (std::size_t i = 0; i < place.size(); ++i) radiance[i] = place[i] == none ? vec3(0) : last[place[i]];
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const std::uint32_t i = chosen[k];
        radiance[i] = place[i] == none ? fresh[k] : weight * radiance[i] + (1.0f - weight) * fresh[k];
    }
    return radiance;
}

}  // namespace

LitVoxels light_voxels(const BlendHistory& technique, const LightingTask& task) {
    const auto light = [&](const LightingTask& some) {
        return std::visit([&](const auto& own) { return light_voxels(own, some); }, technique.light_voxels);
    };
    if (task.last.lit == nullptr) return light(task);
    const LitVoxels& last = *task.last.lit;
    const VoxelGrid& grid = *task.voxels;
    std::vector<std::uint32_t> place = places_in(*last.grid, grid);
    const std::uint32_t frame = last.frame + 1;
    const std::vector<std::uint32_t> chosen = to_be_lit(grid, place, technique.slabs, frame);
    LightingTask part = task;
    if (chosen.size() < grid.size()) part.voxels = part_of(grid, chosen);
    const LitVoxels fresh = light(part);
    if (fresh.back.empty() != last.back.empty() && last.grid->size() > 0 && fresh.grid->size() > 0)
        throw std::invalid_argument("BlendHistory: the history has other sides lit than the technique lights");

    LitVoxels lit;
    lit.grid = task.voxels;
    lit.counts = fresh.counts;
    lit.frame = frame;
    const auto weight = static_cast<float>(technique.weight);
    lit.radiance = blend(weight, place, last.radiance, chosen, fresh.radiance);
    if (!last.back.empty()) lit.back = blend(weight, place, last.back, chosen, fresh.back);
    return lit;
}

}  // namespace interreflect
