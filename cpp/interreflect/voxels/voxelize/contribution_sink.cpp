#include "voxels/voxelize/contribution_sink.h"

namespace interreflect {

void ContributionSink::begin_placed() {
    const VoxelTriangle& t = *triangle_;
    origin_ = t.linear[0];
    linear_area_ = handing_ == Handing::grids ? static_cast<float>(1 << (2 * t.cascade)) : 1.0f;
    if (handing_ != Handing::pieces && handing_ != Handing::sampled) return;
    middle_ = (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0f;
    along_[0] = t.linear[1] - t.linear[0];
    along_[1] = t.linear[2] - t.linear[0];
    const vec3 e1 = t.corner[1] - t.corner[0], e2 = t.corner[2] - t.corner[0], normal = glm::cross(e1, e2);
    const float scale = 1.0f / glm::dot(normal, normal);
    to_weights_[0] = glm::cross(e2, normal) * scale;
    to_weights_[1] = glm::cross(normal, e1) * scale;
    linear_area_ = 0.5f * glm::length(glm::cross(along_[0], along_[1])) / t.area;
}

void ContributionSink::add_warped(const vec3& position, float area, bool solid, const vec3& albedo, const vec3& emitted) {
    const bool one_grid = handing_ == Handing::grids;
    const vec3 p = handing_ == Handing::sampled ? linear_in_piece(position)
                   : one_grid                   ? domain_.linear_in(triangle_->cascade, position)
                                                : position;
    const VoxelPlace at = domain_.place(p);
    if (!domain_.inside(at.voxels) || (one_grid && at.cascade != triangle_->cascade)) return;
    const ivec3 cell(at.voxels);
    add(domain_.cell(cell, at.cascade), p - origin_, area, solid, albedo, emitted);
}

void ContributionSink::place_part(Contribution& c) const {
    const vec3 sum(c.position);
    vec3 placed = sum;
    if (warps_samples_) {
        placed += (origin_ - domain_.reference(c.cell)) * c.area();
    } else {
        const vec3 centre = vec3(domain_.coordinates(c.cell)) + 0.5f;
        c.cell += domain_.cell(ivec3(0), triangle_->cascade);
        if (c.area() > 0.0f) placed = (linear_in_piece(centre + sum / c.area()) - domain_.reference(c.cell)) * c.area();
    }
    // Areas weigh the parts of a cell against each other: as in space, not as in the warped grid.
    c.position = vec4(placed, c.total()) * linear_area_;
    c.albedo *= linear_area_;
}

void ContributionSink::end_emission() {
    std::size_t kept = first_emission_;
    for (std::size_t i = first_; i < surface.size(); ++i) {
        const vec3 sum = emission[first_emission_ + (i - first_)].emission;
        if (max_component(sum) > 0.0f) emission[kept++] = {surface[i].cell, sum * linear_area_};
    }
    emission.shrink(kept);
}

}  // namespace interreflect
