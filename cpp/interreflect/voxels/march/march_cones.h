/// The kernel of the march: many cones of one angle through one pyramid.
#pragma once
#include "data/voxel_grid.h"
#include "voxels/march/cone_schedule.h"

namespace interreflect {

/// Cones with a common schedule, in parallel arrays. Directions need not agree, but neighbours that do read the same texels.
struct ConeBatch {
    static constexpr int capacity = 256;

    int count = 0;
    alignas(64) float x[capacity], y[capacity], z[capacity];     // start, voxels of the pyramid's domain
    alignas(64) float dx[capacity], dy[capacity], dz[capacity];  // unit direction
    // Results: radiance in the pyramid's unit (times `scale` is W/(m^2 sr)), and the share that leaves the domain unblocked.
    alignas(64) float r[capacity], g[capacity], b[capacity], open[capacity];
};

struct ConeCounts {
    std::uint64_t steps = 0, fetches = 0;
};

/// Marches every cone front to back until it has left the domain or less than `cut_off` of it is open; what is left is then
/// counted as if it looked like what came before.
ConeCounts march_cones(const Pyramid& pyramid, const ConeSchedule& schedule, float cut_off, ConeBatch& batch);

}  // namespace interreflect
