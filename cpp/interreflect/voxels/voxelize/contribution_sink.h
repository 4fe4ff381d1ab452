#pragma once
#include <array>

#include "voxels/voxelize/contribution.h"

namespace interreflect {

/// Adds up the samples of one triangle by cell before they are kept: neighbouring samples mostly share one of 2 x 2 x 2 cells.
class ContributionSink {
  public:
    ContributionSink(const Domain& domain, Handing handing, CellMarks& marks)
        : domain_(domain),
          handing_(handing),
          plain_(domain.plain()),
          // Pieces for nested grids are flat.
          warps_samples_(!plain_ && handing != Handing::pieces && !(handing == Handing::sampled && domain.cascades > 1)),
          marks_(marks) {}

    std::vector<Contribution> surface;
    std::vector<EmissionContribution> emission;
    std::uint64_t samples = 0;

    void begin(const VoxelTriangle& triangle) {
        triangle_ = &triangle;
        emits_ = triangle.material->emits();
        if (!plain_) begin_placed();
    }
    /// A sample of the current triangle at `position` voxels that stands for `area`; dropped outside the domain.
    [[gnu::always_inline]] void add(const vec3& position, float area, bool solid, const vec3& albedo, const vec3& emitted) {
        if (warps_samples_) return add_warped(position, area, solid, albedo, emitted);
        const vec3 at = plain_ ? position : within_piece(position);
        const vec3 floor = glm::floor(at);
        if (!inside(floor)) return;
        add(ivec3(floor), at - floor - 0.5f, area, solid, albedo, emitted);
    }
    /// The only sample of the current triangle.
    [[gnu::always_inline]] void add_only(const vec3& position, bool solid, const vec3& albedo, const vec3& emitted) {
        if (warps_samples_) return add_warped(position, triangle_->area, solid, albedo, emitted);
        const vec3 at = plain_ ? position : within_piece(position);
        const vec3 floor = glm::floor(at);
        if (!inside(floor)) return;
        ++samples;
        const float area = triangle_->area, share = solid ? area : 0.0f;
        keep(domain_.cell(ivec3(floor)), vec4(albedo, 1.0f) * share, vec4((at - floor - 0.5f) * share, area), emitted * share);
    }
    /// The same with the cell given, which lies in the domain, and the position from its centre.
    [[gnu::always_inline]] void add(const ivec3& at, const vec3& local, float area, bool solid, const vec3& albedo,
                                    const vec3& emitted) {
        add(domain_.cell(at), at, local, area, solid, albedo, emitted);
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
    [[gnu::always_inline]] void add(std::uint32_t cell, const ivec3& at, const vec3& local, float area, bool solid,
                                    const vec3& albedo, const vec3& emitted) {
        ++samples;
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
        c.normal = triangle_->facing;
        c.offset = triangle_->offset;
        c.back = triangle_->material->two_sided ? 1U : 0U;
        if (!plain_) place_part(c);
        if (albedo.w > 0.0f) marks_.mark(c.cell);
        if (emits_ && max_component(emitted) > 0.0f) emission.push_back({c.cell, emitted * linear_area_});
    }

    void begin_placed();
    /// A sample in linear voxels: warped, and put into the grid that it falls into.
    void add_warped(const vec3& position, float area, bool solid, const vec3& albedo, const vec3& emitted);
    /// Brings a contribution's cell and sums from the current triangle's space to the domain's.
    void place_part(Contribution& c) const;

    const Domain& domain_;
    const Handing handing_;
    const bool plain_, warps_samples_;
    CellMarks& marks_;
    /// A hair towards the middle: pieces end at the faces of nested grids, and what lies on a face belongs to the piece's grid.
    vec3 within_piece(const vec3& position) const { return position + (middle_ - position) * 1e-4f; }
    /// Linear voxels of a place in the current piece.
    vec3 linear_in_piece(const vec3& q) const {
        const vec3 from = q - triangle_->corner[0];
        return origin_ + along_[0] * glm::dot(to_weights_[0], from) + along_[1] * glm::dot(to_weights_[1], from);
    }

    // Of a piece: q are warped voxels, p linear ones. Weights of its second and third corner are to_weights_ (q - first corner).
    vec3 to_weights_[2] = {}, origin_{0}, along_[2] = {}, middle_{0};
    float linear_area_ = 1;  // of a face of a voxel
    const VoxelTriangle* triangle_ = nullptr;
    bool emits_ = false;
    unsigned used_ = 0;
    std::array<Slot, 8> slots_;
};

}  // namespace interreflect
