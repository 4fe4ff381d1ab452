/// The kernel of the march: many cones of one angle through one pyramid.
#pragma once
#include "data/voxel_grid.h"
#include "voxels/march/air_map.h"
#include "voxels/march/cone_schedule.h"

namespace interreflect {

/// Cones with a common schedule, in parallel arrays. Directions need not agree, but neighbours that do read the same texels.
struct ConeBatch {
    static constexpr int capacity = 256;

    int count = 0;
    alignas(64) float x[capacity], y[capacity], z[capacity];     // start, voxels of the pyramid's domain
    alignas(64) float dx[capacity], dy[capacity], dz[capacity];  // unit direction
    // The plane of the receiver, which is taken out of what the cones see; width 0: nothing is.
    alignas(64) float height[capacity], slope[capacity];  // of the start above the plane, voxels; of the height along the cone
    alignas(64) float width[capacity];                    // |nx| + |ny| + |nz| of its normal: the thickness of a layer of voxels
    // The coordinate along the normal's largest component, of the plane, the start and the direction, and how far the normal
    // agrees with that axis: 1 where the layer's place in the grid is known, 0 where its mean over all places must do.
    alignas(64) float axis_plane[capacity], axis_start[capacity], axis_direction[capacity], aligned[capacity];
    alignas(64) float axis_cells[capacity];  // size of the domain along that axis
    // Where `limited`: the cone ends where its filter reaches this far from the start, linear voxels.
    bool limited = false;
    alignas(64) float limit[capacity];
    // Where the domain is not plain: starts and directions are in linear voxels, and the plane is the one that touches the warped
    // surface. How long the start's voxels are in linear ones; the plane's unit normal; the number of its longest axis.
    alignas(64) float scale[capacity];
    alignas(64) float nx[capacity], ny[capacity], nz[capacity], axis[capacity];
    // Results: radiance in the pyramid's unit (times `scale` is W/(m^2 sr)), and the share that leaves the domain unblocked.
    alignas(64) float r[capacity], g[capacity], b[capacity], open[capacity];
};

/// Within 8 degrees of an axis: over the few texels of a filter such a plane stays in one layer.
inline constexpr float aligned_cosine = 0.99f;

/// The axis along which a normal is longest.
inline int longest_axis(const vec3& normal) {
    const vec3 size = glm::abs(normal);
    return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

/// set_start where the domain is not plain.
void set_warped_start(ConeBatch& batch, int i, const Domain& domain, const vec3& surface, const vec3& normal, float offset,
                      bool see_own_surface);

/// Enters where cone `i` starts: `offset` voxels above the plane through `surface` (linear voxels) with that normal.
inline void set_start(ConeBatch& batch, int i, const Domain& domain, const vec3& surface, const vec3& normal, float offset,
                      bool see_own_surface) {
    if (!domain.plain()) return set_warped_start(batch, i, domain, surface, normal, offset, see_own_surface);
    const vec3 start = surface + normal * offset, size = glm::abs(normal);
    const int axis = longest_axis(normal);
    batch.x[i] = start.x, batch.y[i] = start.y, batch.z[i] = start.z;
    batch.height[i] = offset;
    batch.width[i] = see_own_surface ? 0.0f : size.x + size.y + size.z;
    batch.axis_plane[i] = surface[axis];
    batch.axis_start[i] = start[axis];
    batch.axis_cells[i] = static_cast<float>(domain.cells[axis]);
    batch.aligned[i] = size[axis] > aligned_cosine ? 1.0f : 0.0f;
}

/// Enters where cone `i` goes; `normal` is that of its start.
inline void set_direction(ConeBatch& batch, int i, const vec3& normal, const vec3& direction) {
    batch.dx[i] = direction.x, batch.dy[i] = direction.y, batch.dz[i] = direction.z;
    batch.slope[i] = glm::dot(direction, normal);
    batch.axis_direction[i] = direction[longest_axis(normal)];
}

struct ConeCounts {
    std::uint64_t steps = 0, fetches = 0;
};

/// Marches every cone front to back until it has left the domain or less than `cut_off` of it is open; what is left is then
/// counted as if it looked like what came before. `air` is the pyramid's.
ConeCounts march_cones(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch);

}  // namespace interreflect
