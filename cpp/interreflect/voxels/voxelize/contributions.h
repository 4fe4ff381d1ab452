/// What every voxelization shares: triangles brought into voxels, and the parts of triangles in cells merged into voxels.
///
/// A technique emits contributions, triangle by triangle, in fixed pieces; they are merged cell by cell in the order of the
/// pieces, so the result is the same at any number of threads.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "data/scene.h"
#include "data/voxel_grid.h"
#include "math/parallel.h"

namespace interreflect {

/// A triangle in units of voxels from the domain's lower corner, with what its surface looks like.
struct VoxelTriangle {
    vec3 corner[3];
    vec2 texcoord[3];
    vec3 normal{0};  // unit, front side
    float area = 0;  // in faces of a voxel
    std::uint32_t instance = 0, triangle = 0;
    const Material* material = nullptr;
    const Texture* albedo_map = nullptr;
    const Texture* emission_map = nullptr;
    const Mask* mask = nullptr;

    vec2 texcoord_at(float u, float v) const { return texcoord[0] * (1.0f - u - v) + texcoord[1] * u + texcoord[2] * v; }
    /// The mip level whose texels are as large as `sample_area` (faces of a voxel) of this triangle.
    int level(const Texture& texture, float sample_area) const;
};

/// False for a triangle without area.
bool make_voxel_triangle(const Scene& scene, const Domain& domain, std::uint32_t instance, std::uint32_t triangle,
                         VoxelTriangle& made);

/// The part of one triangle in one cell. Sums are weighted by area.
struct Contribution {
    std::uint32_t cell = 0;
    std::uint32_t instance = 0, triangle = 0;
    float area = 0;    // solid part, in faces of a voxel
    float total = 0;   // with the holes of its mask
    vec3 albedo{0};    // sum
    vec3 position{0};  // sum, in voxels from the cell's centre
    vec3 normal{0};    // unit
};
struct EmissionContribution {
    std::uint32_t cell = 0;
    vec3 emission{0};  // sum
};
struct Contributions {
    std::vector<Contribution> surface;
    std::vector<EmissionContribution> emission;
    std::uint64_t samples = 0;
};

/// Adds up the samples of one triangle by cell before they are written: neighbouring samples mostly share one of 2 x 2 x 2 cells.
class ContributionSink {
  public:
    ContributionSink(const Domain& domain, Contributions& out) : domain_(domain), out_(out) {}

    void begin(const VoxelTriangle& triangle) { triangle_ = &triangle; }
    /// A sample of the current triangle at `position` voxels that stands for `area`; dropped outside the domain.
    void add(const vec3& position, float area, bool solid, const vec3& albedo, const vec3& emission) {
        const vec3 floor = glm::floor(position);
        add(ivec3(floor), position - floor - 0.5f, area, solid, albedo, emission);
    }
    /// The same with the cell given, and the position from its centre.
    void add(const ivec3& at, const vec3& local, float area, bool solid, const vec3& albedo, const vec3& emission) {
        const ivec3& n = domain_.cells;
        if (static_cast<unsigned>(at.x) >= static_cast<unsigned>(n.x) ||
            static_cast<unsigned>(at.y) >= static_cast<unsigned>(n.y) ||
            static_cast<unsigned>(at.z) >= static_cast<unsigned>(n.z))
            return;
        ++out_.samples;
        const std::uint32_t cell = domain_.cell(at);
        Slot& slot = slots_[static_cast<unsigned>((at.x & 1) | (at.y & 1) << 1 | (at.z & 1) << 2)];
        if (slot.cell != cell) {
            flush(slot);
            slot.cell = cell;
        }
        slot.total += area;
        if (!solid) return;
        slot.area += area;
        slot.albedo += albedo * area;
        slot.position += local * area;
        slot.emission += emission * area;
    }
    void end() {
        for (Slot& slot : slots_) flush(slot);
    }

  private:
    static constexpr std::uint32_t none = ~0U;
    struct Slot {
        std::uint32_t cell = none;
        float area = 0, total = 0;
        vec3 albedo{0}, position{0}, emission{0};
    };
    void flush(Slot& slot) {
        if (slot.cell == none) return;
        out_.surface.push_back({slot.cell, triangle_->instance, triangle_->triangle, slot.area, slot.total, slot.albedo,
                                slot.position, triangle_->normal});
        if (max_component(slot.emission) > 0.0f) out_.emission.push_back({slot.cell, slot.emission});
        slot = Slot{};
    }

    const Domain& domain_;
    Contributions& out_;
    const VoxelTriangle* triangle_ = nullptr;
    std::array<Slot, 8> slots_;
};

/// Triangles [begin, end) of one instance.
struct TrianglePiece {
    std::uint32_t instance, begin, end;
};
std::vector<TrianglePiece> triangle_pieces(const Geometry& geometry);

/// The voxels that the contributions of all pieces make up.
VoxelGrid merge_contributions(const Scene& scene, const Domain& domain, std::vector<Contributions> pieces);

/// Calls emit(triangle, sink) for every triangle of the scene and merges what it adds.
template <class Emit>
VoxelGrid voxelize_triangles(const Scene& scene, const Domain& domain, const Emit& emit) {
    const auto pieces = triangle_pieces(*scene.geometry);
    std::vector<Contributions> contributions(pieces.size());
    parallel_pieces(pieces.size(), [&](std::size_t i) {
        ContributionSink sink(domain, contributions[i]);
        contributions[i].surface.reserve(2 * (pieces[i].end - pieces[i].begin));
        VoxelTriangle triangle;
        for (std::uint32_t t = pieces[i].begin; t < pieces[i].end; ++t) {
            if (!make_voxel_triangle(scene, domain, pieces[i].instance, t, triangle)) continue;
            sink.begin(triangle);
            emit(triangle, sink);
            sink.end();
        }
    });
    return merge_contributions(scene, domain, std::move(contributions));
}

}  // namespace interreflect
