/// The kernel of the march: many cones of one angle through one pyramid.
#pragma once
#include "data/voxel_grid.h"
#include "voxels/march/air_map.h"
#include "voxels/march/cone_schedule.h"

namespace interreflect {

/// Depth of a cone that nothing blocks.
inline constexpr float nothing_there = 1e30f;

/// Cones with a common schedule, in parallel arrays. Directions need not agree, but neighbours that do read the same texels.
struct ConeBatch {
    static constexpr int capacity = 256;

    int count = 0;
    bool limited = false, merged = false;
    alignas(64) float x[capacity], y[capacity], z[capacity];     // start, voxels of the pyramid's domain
    alignas(64) float dx[capacity], dy[capacity], dz[capacity];  // unit direction
    // The plane of the receiver, which is taken out of what the cones see: its unit normal, and `height` the negative of its
    // distance from the origin, voxels. `width`, |nx| + |ny| + |nz|, is the thickness of a layer of voxels; 0: nothing is taken
    // out.
    alignas(64) float nx[capacity], ny[capacity], nz[capacity], height[capacity], width[capacity];
    // The number of the normal's longest axis, the plane's and the domain's size along it, and how far the normal agrees with it:
    // 1 where the layer's place in the grid is known, 0 where its mean over all places must do.
    alignas(64) float axis[capacity], axis_plane[capacity], axis_cells[capacity], aligned[capacity];
    // Where `limited`: the cone ends where its filter reaches this far from the start, linear voxels.
    alignas(64) float limit[capacity];
    // Where the domain is not plain, starts and directions are in linear voxels, the plane is the one that touches the warped
    // surface, and this is how long the start's voxels are in linear ones.
    alignas(64) float scale[capacity];
    // Where `merged`: cones start anywhere, and `depth` is asked for, the mean distance of what blocks them, linear voxels;
    // nothing_there where nothing does.
    alignas(64) float depth[capacity];
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

/// Enters the plane through `at` (voxels) with that normal as what cone `i` starts from.
inline void set_plane(ConeBatch& batch, int i, const Domain& domain, const vec3& at, const vec3& normal, bool see_own_surface) {
    const vec3 size = glm::abs(normal);
    const int axis = longest_axis(normal);
    batch.nx[i] = normal.x, batch.ny[i] = normal.y, batch.nz[i] = normal.z;
    batch.height[i] = -glm::dot(normal, at);
    batch.width[i] = see_own_surface ? 0.0f : size.x + size.y + size.z;
    batch.axis[i] = static_cast<float>(axis);
    batch.axis_plane[i] = at[axis];
    batch.axis_cells[i] = static_cast<float>(domain.cells[axis] << (domain.cascades - 1));
    batch.aligned[i] = size[axis] > aligned_cosine ? 1.0f : 0.0f;
}

/// set_start where the domain is not plain.
void set_warped_start(ConeBatch& batch, int i, const Domain& domain, const vec3& surface, const vec3& normal, float offset,
                      bool see_own_surface);

/// Enters where cone `i` starts: `offset` voxels above the plane through `surface` (linear voxels) with that normal.
inline void set_start(ConeBatch& batch, int i, const Domain& domain, const vec3& surface, const vec3& normal, float offset,
                      bool see_own_surface) {
    if (!domain.plain()) return set_warped_start(batch, i, domain, surface, normal, offset, see_own_surface);
    const vec3 start = surface + normal * offset;
    batch.x[i] = start.x, batch.y[i] = start.y, batch.z[i] = start.z;
    set_plane(batch, i, domain, surface, normal, see_own_surface);
}

inline void set_direction(ConeBatch& batch, int i, const vec3& direction) {
    batch.dx[i] = direction.x, batch.dy[i] = direction.y, batch.dz[i] = direction.z;
}

struct ConeCounts {
    std::uint64_t steps = 0, fetches = 0;
};

/// Marches every cone front to back until it has left the domain or less than `cut_off` of it is open; what is left is then
/// counted as if it looked like what came before. `air` is the pyramid's.
ConeCounts march_cones(const Pyramid& pyramid, const AirMap& air, const ConeSchedule& schedule, float cut_off, ConeBatch& batch);

}  // namespace interreflect
