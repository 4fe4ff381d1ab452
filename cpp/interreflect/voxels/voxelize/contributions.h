/// What every voxelization shares: triangles brought into voxels, and the parts of triangles in cells merged into voxels.
///
/// A technique emits contributions, triangle by triangle, in fixed pieces; they are merged cell by cell in the order of the
/// pieces, so the result is the same at any number of threads.
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "data/scene.h"
#include "data/voxel_grid.h"

namespace interreflect {

/// A triangle in units of voxels from the domain's lower corner, with what its surface looks like.
struct VoxelTriangle {
    vec3 corner[3];
    vec2 texcoord[3];
    vec3 normal{0};        // unit, front side
    float area = 0;        // in faces of a voxel
    float offset = 0;      // of rays that leave it, world space
    bool crosses = false;  // the domain's border
    const Material* material = nullptr;
    const Texture* albedo_map = nullptr;
    const Texture* emission_map = nullptr;
    const Mask* mask = nullptr;

    bool uniform() const { return albedo_map == nullptr && emission_map == nullptr && mask == nullptr; }
    /// The mip level whose texels are as large as `sample_area` (faces of a voxel) of this triangle.
    int level(const Texture& texture, float sample_area) const;
};

/// The part of one triangle in one cell. Sums are weighted by area.
struct Contribution {
    std::uint32_t cell = 0;
    float area = 0;    // solid part, in faces of a voxel
    float total = 0;   // with the holes of its mask
    vec3 albedo{0};    // sum
    vec3 position{0};  // sum, in voxels from the cell's centre
    vec3 normal{0};    // unit
    float offset = 0;  // of the triangle
    std::uint32_t back = 0;
};
struct EmissionContribution {
    std::uint32_t cell = 0;
    vec3 emission{0};  // sum
};

/// The cells that hold something solid, marked by all threads; the marks owe nothing to their order.
class CellMarks {
  public:
    explicit CellMarks(std::size_t cells) : words_((cells + 63) / 64), first_(words_.size() + 1) {}

    void mark(std::uint32_t cell) {
        const std::uint64_t bit = std::uint64_t{1} << (cell & 63U);
        std::atomic_ref<std::uint64_t> word(words_[cell >> 6U]);
        if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
    }
    /// Numbers the marked cells in ascending order.
    void number();
    bool marked(std::uint32_t cell) const { return ((words_[cell >> 6U] >> (cell & 63U)) & 1U) != 0; }
    /// How many marked cells come before this one.
    std::uint32_t before(std::uint64_t cell) const {
        const std::size_t word = cell >> 6U;
        if (word == words_.size()) return first_.back();
        const std::uint64_t below = (std::uint64_t{1} << (cell & 63U)) - 1;
        return first_[word] + static_cast<std::uint32_t>(std::popcount(words_[word] & below));
    }
    std::uint32_t count() const { return first_.back(); }

  private:
    std::vector<std::uint64_t> words_;
    std::vector<std::uint32_t> first_;
};

/// Adds up the samples of one triangle by cell before they are kept: neighbouring samples mostly share one of 2 x 2 x 2 cells.
class ContributionSink {
  public:
    ContributionSink(const Domain& domain, CellMarks& marks) : domain_(domain), marks_(marks) {}

    std::vector<Contribution> surface;
    std::vector<EmissionContribution> emission;
    std::uint64_t samples = 0;

    void begin(const VoxelTriangle& triangle) {
        triangle_ = &triangle;
        emits_ = triangle.material->emits();
    }
    /// A sample of the current triangle at `position` voxels that stands for `area`; dropped outside the domain.
    [[gnu::always_inline]] void add(const vec3& position, float area, bool solid, const vec3& albedo, const vec3& emitted) {
        const vec3 floor = glm::floor(position);
        if (!inside(floor)) return;
        add(ivec3(floor), position - floor - 0.5f, area, solid, albedo, emitted);
    }
    /// The only sample of the current triangle.
    [[gnu::always_inline]] void add_only(const vec3& position, bool solid, const vec3& albedo, const vec3& emitted) {
        const vec3 floor = glm::floor(position);
        if (!inside(floor)) return;
        ++samples;
        const float area = triangle_->area, share = solid ? area : 0.0f;
        keep(domain_.cell(ivec3(floor)), vec4(albedo, 1.0f) * share, vec4((position - floor - 0.5f) * share, area),
             emitted * share);
    }
    /// The same with the cell given, which lies in the domain, and the position from its centre.
    [[gnu::always_inline]] void add(const ivec3& at, const vec3& local, float area, bool solid, const vec3& albedo,
                                    const vec3& emitted) {
        ++samples;
        const std::uint32_t cell = domain_.cell(at);
        const unsigned number = static_cast<unsigned>((at.x & 1) | (at.y & 1) << 1 | (at.z & 1) << 2);
        Slot& slot = slots_[number];
        if ((used_ >> number & 1U) == 0 || slot.cell != cell) {
            if ((used_ >> number & 1U) != 0) flush(slot);
            used_ |= 1U << number;
            slot = Slot{};
            slot.cell = cell;
        }
        const float share = solid ? area : 0.0f;
        slot.albedo += vec4(albedo, 1.0f) * share;
        slot.position += vec4(local * share, area);
        if (emits_) slot.emission += emitted * share;
    }
    void end() {
        for (; used_ != 0; used_ &= used_ - 1) flush(slots_[static_cast<unsigned>(std::countr_zero(used_))]);
    }
    void clear() {
        surface.clear();
        emission.clear();
        samples = 0;
    }

  private:
    struct Slot {
        std::uint32_t cell = 0;
        vec4 albedo{0}, position{0};  // sums; the fourth ones: of the solid part's area, and of all area
        vec3 emission{0};
    };
    bool inside(const vec3& floor) const {
        const vec3 n(domain_.cells);
        return floor.x >= 0.0f && floor.y >= 0.0f && floor.z >= 0.0f && floor.x < n.x && floor.y < n.y && floor.z < n.z;
    }
    void flush(const Slot& slot) { keep(slot.cell, slot.albedo, slot.position, slot.emission); }
    [[gnu::always_inline]] void keep(std::uint32_t cell, const vec4& albedo, const vec4& position, const vec3& emitted) {
        // Field by field: a whole value would be put together elsewhere and copied.
        Contribution& c = surface.emplace_back();
        c.cell = cell;
        c.area = albedo.w;
        c.total = position.w;
        c.albedo = vec3(albedo);
        c.position = vec3(position);
        c.normal = triangle_->normal;
        c.offset = triangle_->offset;
        c.back = triangle_->material->two_sided ? 1U : 0U;
        if (albedo.w > 0.0f) marks_.mark(cell);
        if (emits_ && max_component(emitted) > 0.0f) emission.push_back({cell, emitted});
    }

    const Domain& domain_;
    CellMarks& marks_;
    const VoxelTriangle* triangle_ = nullptr;
    bool emits_ = false;
    unsigned used_ = 0;
    std::array<Slot, 8> slots_;
};

/// Calls `emit` for every triangle of the scene and merges what it adds to the sink.
using EmitTriangle = std::function<void(const VoxelTriangle&, ContributionSink&)>;
VoxelGrid voxelize_triangles(const Scene& scene, const Domain& domain, const EmitTriangle& emit);

}  // namespace interreflect
