#include "voxels/voxelize/contributions.h"

#include <algorithm>

#include "visibility/surface.h"

namespace interreflect {
namespace {

constexpr std::uint32_t triangles_of_piece = 1024;

/// What has been merged into one voxel so far.
struct Voxel {
    std::uint32_t cell = 0;
    float area = 0, total = 0;
    vec3 albedo{0}, position{0}, normal{0}, emission{0};
    float largest = -1.0f;
    const Contribution* representative = nullptr;  // the largest part of a triangle in the cell, the first of equals

    void add(const Contribution& c) {
        area += c.area;
        total += c.total;
        albedo += c.albedo;
        position += c.position;
        normal += c.normal * c.area;
        if (c.area > largest) {
            largest = c.area;
            representative = &c;
        }
    }
};

/// Contributions of one piece in the order of their buckets (ranges of cells); within a bucket, in the order they were emitted.
struct Sorted {
    std::vector<std::uint32_t> order, first;  // first[bucket], buckets + 1 of them
};
template <class Item>
Sorted sort_by_bucket(const std::vector<Item>& items, std::size_t buckets, int shift) {
    Sorted sorted{std::vector<std::uint32_t>(items.size()), std::vector<std::uint32_t>(buckets + 1)};
    for (const auto& item : items) ++sorted.first[(item.cell >> shift) + 1];
    for (std::size_t b = 0; b < buckets; ++b) sorted.first[b + 1] += sorted.first[b];
    std::vector<std::uint32_t> next(sorted.first.begin(), sorted.first.end() - 1);
    for (std::uint32_t i = 0; i < items.size(); ++i) sorted.order[next[items[i].cell >> shift]++] = i;
    return sorted;
}

struct Buckets {
    int shift = 14;  // 16,384 cells a bucket: their slots stay in a core's own cache
    std::size_t count = 1;

    explicit Buckets(std::size_t cells) {
        while ((cells >> shift) > 1024) ++shift;
        count = (cells >> shift) + 1;
    }
    std::size_t cells() const { return std::size_t{1} << shift; }
};

/// The voxels of one bucket, in ascending order of cells.
std::vector<Voxel> merge_bucket(std::size_t bucket, const Buckets& buckets, const std::vector<Contributions>& pieces,
                                const std::vector<Sorted>& surface, const std::vector<Sorted>& emission) {
    std::vector<Voxel> voxels;
    std::vector<std::uint32_t> slot(buckets.cells(), 0);  // 1 + index of the cell's voxel
    const std::uint32_t first_cell = static_cast<std::uint32_t>(bucket << buckets.shift);
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        for (std::uint32_t i = surface[p].first[bucket]; i < surface[p].first[bucket + 1]; ++i) {
            const Contribution& c = pieces[p].surface[surface[p].order[i]];
            std::uint32_t& at = slot[c.cell - first_cell];
            if (at == 0) {
                voxels.push_back({});
                voxels.back().cell = c.cell;
                at = static_cast<std::uint32_t>(voxels.size());
            }
            voxels[at - 1].add(c);
        }
    }
    for (std::size_t p = 0; p < pieces.size(); ++p)
        for (std::uint32_t i = emission[p].first[bucket]; i < emission[p].first[bucket + 1]; ++i) {
            const EmissionContribution& e = pieces[p].emission[emission[p].order[i]];
            voxels[slot[e.cell - first_cell] - 1].emission += e.emission;
        }
    std::vector<Voxel> ascending;
    ascending.reserve(voxels.size());
    for (const std::uint32_t at : slot)
        if (at != 0 && voxels[at - 1].area > 0.0f) ascending.push_back(voxels[at - 1]);
    return ascending;
}

void write_voxel(const Scene& scene, const Voxel& voxel, std::size_t i, VoxelGrid& grid) {
    const Domain& domain = grid.domain;
    const float share = 1.0f / voxel.area;
    const vec3 centre = vec3(domain.coordinates(voxel.cell)) + 0.5f;
    grid.cell[i] = voxel.cell;
    grid.albedo[i] = voxel.albedo * share;
    grid.emission[i] = voxel.emission * share;
    grid.position[i] = domain.to_world(centre + voxel.position * share);
    grid.opacity[i] = voxel.total > voxel.area ? voxel.area / voxel.total : 1.0f;
    // Opposite sides that cancel leave rounding only: 1e-3 of the area is no direction.
    const float length = glm::length(voxel.normal);
    grid.normal[i] = length > 1e-3f * voxel.area ? voxel.normal / length : vec3(0);
    const Contribution& c = *voxel.representative;
    const float offset = self_hit_offset(*scene.geometry, c.instance, c.triangle);
    const Material& material = scene.materials[scene.material_of(c.triangle)];
    grid.points[i] = {domain.to_world(centre + c.position / c.area), offset, c.normal, material.two_sided ? 1U : 0U};
}

void resize(VoxelGrid& grid, std::size_t size) {
    grid.cell = Buffer<std::uint32_t>(size);
    grid.albedo = Buffer<vec3>(size);
    grid.normal = Buffer<vec3>(size);
    grid.emission = Buffer<vec3>(size);
    grid.position = Buffer<vec3>(size);
    grid.opacity = Buffer<float>(size);
    grid.points = Buffer<VoxelPoint>(size);
}

}  // namespace

int VoxelTriangle::level(const Texture& texture, float sample_area) const {
    const vec2 du = texcoord[1] - texcoord[0], dv = texcoord[2] - texcoord[0];
    const float share = 0.5f * std::fabs(du.x * dv.y - du.y * dv.x) * sample_area / area;
    const float texels = share * static_cast<float>(texture.width()) * static_cast<float>(texture.height());
    if (!(texels >= 2.0f)) return 0;
    // Nearest level: round(log2(texels) / 2).
    return std::min((std::ilogb(texels) + 1) / 2, texture.levels() - 1);
}

bool make_voxel_triangle(const Scene& scene, const Domain& domain, std::uint32_t instance, std::uint32_t triangle,
                         VoxelTriangle& made) {
    const Corners world = world_corners(*scene.geometry, instance, triangle);
    made.corner[0] = domain.to_voxels(world.a);
    made.corner[1] = domain.to_voxels(world.b);
    made.corner[2] = domain.to_voxels(world.c);
    const vec3 cross = glm::cross(made.corner[1] - made.corner[0], made.corner[2] - made.corner[0]);
    const float length = glm::length(cross);
    if (!(length > 0.0f)) return false;
    made.normal = cross / (scene.geometry->instances[instance].flips ? -length : length);
    made.area = 0.5f * length;
    made.instance = instance;
    made.triangle = triangle;
    const auto& arrays = *scene.geometry->arrays;
    const uvec3 t = arrays.triangles[triangle];
    for (int i = 0; i < 3; ++i) made.texcoord[i] = arrays.texcoords[t[i]];
    const Material& material = scene.materials[arrays.materials[triangle]];
    made.material = &material;
    made.albedo_map = material.albedo_map >= 0 ? scene.textures[material.albedo_map].get() : nullptr;
    made.emission_map = material.emission_map >= 0 && material.emits() ? scene.textures[material.emission_map].get() : nullptr;
    made.mask = material.mask >= 0 ? scene.masks[material.mask].get() : nullptr;
    return true;
}

std::vector<TrianglePiece> triangle_pieces(const Geometry& geometry) {
    std::vector<TrianglePiece> pieces;
    for (std::uint32_t i = 0; i < geometry.instances.size(); ++i) {
        const Group& group = geometry.groups[geometry.instances[i].group];
        const std::uint32_t end = group.first_triangle + group.triangle_count;
        for (std::uint32_t t = group.first_triangle; t < end; t += triangles_of_piece)
            pieces.push_back({i, t, std::min(t + triangles_of_piece, end)});
    }
    return pieces;
}

VoxelGrid merge_contributions(const Scene& scene, const Domain& domain, std::vector<Contributions> pieces) {
    const Buckets buckets(domain.cell_count());
    std::vector<Sorted> surface(pieces.size()), emission(pieces.size());
    parallel_pieces(pieces.size(), [&](std::size_t i) {
        surface[i] = sort_by_bucket(pieces[i].surface, buckets.count, buckets.shift);
        emission[i] = sort_by_bucket(pieces[i].emission, buckets.count, buckets.shift);
    });
    std::vector<std::vector<Voxel>> voxels(buckets.count);
    parallel_pieces(buckets.count, [&](std::size_t b) { voxels[b] = merge_bucket(b, buckets, pieces, surface, emission); });

    std::vector<std::size_t> first(buckets.count + 1);
    for (std::size_t b = 0; b < buckets.count; ++b) first[b + 1] = first[b] + voxels[b].size();
    VoxelGrid grid;
    grid.domain = domain;
    resize(grid, first.back());
    parallel_pieces(buckets.count, [&](std::size_t b) {
        for (std::size_t i = 0; i < voxels[b].size(); ++i) write_voxel(scene, voxels[b][i], first[b] + i, grid);
    });
    for (const auto& piece : pieces) grid.counts.samples += piece.samples;
    grid.counts.voxels = grid.size();
    return grid;
}

}  // namespace interreflect
