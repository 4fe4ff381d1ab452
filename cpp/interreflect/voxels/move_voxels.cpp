#include "voxels/move_voxels.h"

#include <algorithm>

#include "math/parallel.h"

namespace interreflect {
namespace {

template <class Item>
Buffer<Item> copy_of(const Buffer<Item>& from) {
    Buffer<Item> copy(from.size());
    std::copy(from.begin(), from.end(), copy.begin());
    return copy;
}

/// From one pose of a body to another.
struct Motion {
    const BodyPose &from, &to;

    vec3 point(const vec3& p) const { return to.to_world(from.to_body(p)); }
    vec3 direction(const vec3& d) const { return to.direction_to_world(from.direction_to_body(d)); }
    VoxelPoint surface(const VoxelPoint& p) const {
        const vec3 position = point(p.position);
        // As of a hit there: in units in the last place of the largest coordinate.
        const float offset = p.offset + 0x1p-18f * max_component(glm::abs(position));
        return {position, offset, direction(p.normal), p.reflects};
    }
};

}  // namespace

VoxelGrid move_voxels(const VoxelGrid& voxels, const BodyPose& pose) {
    const std::size_t size = voxels.size();
    VoxelGrid moved;
    moved.domain = voxels.domain;
    moved.pose = pose;
    moved.counts.voxels = size;
    moved.cell = copy_of(voxels.cell);
    moved.albedo = copy_of(voxels.albedo);
    moved.emission = copy_of(voxels.emission);
    moved.opacity = copy_of(voxels.opacity);
    moved.area = copy_of(voxels.area);
    moved.normal = Buffer<vec3>(size);
    moved.position = Buffer<vec3>(size);
    moved.points = Buffer<VoxelPoint>(size);
    moved.backs = Buffer<VoxelPoint>(size);
    const Motion motion{voxels.pose, moved.pose};
    parallel_blocks(size, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            moved.normal[i] = motion.direction(voxels.normal[i]);
            moved.position[i] = motion.point(voxels.position[i]);
            moved.points[i] = motion.surface(voxels.points[i]);
            moved.backs[i] = motion.surface(voxels.backs[i]);
        }
    });
    return moved;
}

}  // namespace interreflect
