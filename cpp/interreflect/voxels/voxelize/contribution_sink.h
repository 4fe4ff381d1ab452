#pragma once
#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "voxels/voxelize/contribution.h"
#include "voxels/voxelize/pile.h"
#include "voxels/voxelize/sample_sums.h"

namespace interreflect {

/// Adds up the samples of one triangle by cell. Where a cell's sum stands is looked up by a hash of its number; in the rare case
/// that two cells of a triangle share a hash, either may have several sums.
class ContributionSink {
  public:
    ContributionSink(const Domain& domain, Handing handing, CellMarks& marks)
        : domain_(domain),
          handing_(handing),
          plain_(domain.plain()),
          // Pieces for nested grids are flat.
          warps_samples_(!plain_ && handing != Handing::pieces && !(handing == Handing::sampled && domain.cascades > 1)),
          marks_(marks) {}

    Pile<Contribution> surface;
    Pile<TriangleSide> sides;
    Pile<EmissionContribution> emission;
    std::uint64_t samples = 0;

    /// A triangle that does not emit, in a plain domain.
    void begin(const TriangleSide& side) {
        side_ = side;
        first_ = current_ = static_cast<std::uint32_t>(surface.size());
        first_emission_ = emission.size();
        emits_ = false;
    }
    void begin(const VoxelTriangle& triangle) {
        begin({vec4(triangle.facing, triangle.offset), triangle.material->two_sided ? 1U : 0U});
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
        append(domain_.cell(ivec3(floor)));
        add_to_current(at - floor - 0.5f, triangle_->area, solid, albedo, emitted);
    }
    /// The same with the cell given, which lies in the domain, and the position from its centre.
    [[gnu::always_inline]] void add(const ivec3& at, const vec3& local, float area, bool solid, const vec3& albedo,
                                    const vec3& emitted) {
        add(domain_.cell(at), local, area, solid, albedo, emitted);
    }
    /// Solid samples of a triangle that does not emit; not where every sample is warped.
    void add(const SampleSums& sums, int count) {
        for (int i = 0; i < count; ++i) {
            if (sums.cell[i] == SampleSums::outside) continue;
            find(sums.cell[i]);
            add_to_current(sums, i);
        }
    }
    /// One of very few.
    void add_one_of(const SampleSums& sums, int i) {
        if (sums.cell[i] == SampleSums::outside) return;
        for (current_ = first_; current_ < surface.size(); ++current_)
            if (surface[current_].cell == sums.cell[i]) return add_to_current(sums, i);
        append(sums.cell[i]);
        add_to_current(sums, i);
    }
    /// The current triangle, or piece of one, as those samples must see it.
    bool takes_sums() const { return !warps_samples_ && !emits_; }
    vec3 seen(const vec3& position) const { return plain_ ? position : within_piece(position); }
    void end() {
        if (surface.size() == first_) return;
        const auto side = static_cast<std::uint32_t>(sides.size());
        sides.push(side_);
        for (std::size_t i = first_; i < surface.size(); ++i) {
            Contribution& c = surface[i];
            c.side = side;
            if (!plain_) place_part(c);
            if (c.area() > 0.0f) marks_.mark(c.cell);
        }
        if (emits_) end_emission();
    }
    void clear() {
        surface.clear();
        sides.clear();
        emission.clear();
        samples = 0;
    }

  private:
    [[gnu::always_inline]] void add(std::uint32_t cell, const vec3& local, float area, bool solid, const vec3& albedo,
                                    const vec3& emitted) {
        ++samples;
        if (current_ == surface.size() || surface[current_].cell != cell) find(cell);
        add_to_current(local, area, solid, albedo, emitted);
    }
    /// Makes the cell's sum the current one.
    void find(std::uint32_t cell) {
        std::uint32_t& place = places_[(cell * 2654435769U) >> (32 - places_bits)];
        // What earlier triangles left there does not matter: it lies before `first_`, or has become this cell's sum.
        if (place >= first_ && place < surface.size() && surface[place].cell == cell) {
            current_ = place;
            return;
        }
        append(cell);
        place = current_;
    }
    void append(std::uint32_t cell) {
        current_ = static_cast<std::uint32_t>(surface.size());
        surface.push({.cell = cell});
        if (emits_) emission.push({});
    }
    void add_to_current(const SampleSums& sums, int i) {
        ++samples;
        Contribution& c = surface[current_];
        c.albedo += glm::make_vec4(sums.albedo[i].data());
        c.position += glm::make_vec4(sums.position[i].data());
    }
    [[gnu::always_inline]] void add_to_current(const vec3& local, float area, bool solid, const vec3& albedo,
                                               const vec3& emitted) {
        const float share = solid ? area : 0.0f;
        Contribution& c = surface[current_];
        c.albedo += vec4(albedo, 1.0f) * share;
        c.position += vec4(local * share, area);
        if (emits_) emission[first_emission_ + (current_ - first_)].emission += emitted * share;
    }
    bool inside(const vec3& floor) const {
        const vec3 n(domain_.cells);
        return floor.x >= 0.0f && floor.y >= 0.0f && floor.z >= 0.0f && floor.x < n.x && floor.y < n.y && floor.z < n.z;
    }
    void begin_placed();
    /// Gives the emission of the current triangle its cells; none is kept where there is none.
    void end_emission();
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
    TriangleSide side_{};
    bool emits_ = false;
    std::uint32_t first_ = 0, current_ = 0;  // sums of the current triangle, and of the last sample
    std::size_t first_emission_ = 0;
    static constexpr int places_bits = 10;
    std::array<std::uint32_t, 1U << places_bits> places_{};
};

}  // namespace interreflect
