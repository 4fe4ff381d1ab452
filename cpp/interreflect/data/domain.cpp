#include "data/domain.h"

namespace interreflect {

VoxelPlace Domain::place(const vec3& p) const {
    if (cascades == 1) return {0, warp.to_voxels(p, cells)};
    for (int k = 0;; ++k) {
        const vec3 q = in_cascade(k, p);
        if (k + 1 == cascades || inside(q)) return {k, q};
    }
}

vec3 Domain::linear_of(const VoxelPlace& at) const {
    if (cascades == 1) return warp.to_linear(at.voxels, cells);
    return linear_in(at.cascade, at.voxels);
}

mat3 Domain::density(const vec3& p) const {
    if (cascades == 1) return warp.density(p, cells);
    return mat3(1.0f / static_cast<float>(1 << place(p).cascade));
}

}  // namespace interreflect
