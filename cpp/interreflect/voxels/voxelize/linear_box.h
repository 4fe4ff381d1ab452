/// Where samples of whole triangles may fall: the box around a domain, or around one of its nested grids.
#pragma once
#include <algorithm>

#include "voxels/voxelize/contribution.h"

namespace interreflect {

/// In linear voxels, or (`Handing::grids`) in voxels of each of nested grids.
struct LinearBox {
    vec3 lower{0}, upper{0};

    LinearBox(const Domain& domain, Handing handing) {
        const int scale = handing == Handing::at_once ? 1 << (domain.cascades - 1) : 1;
        upper = vec3(domain.cells) * static_cast<float>(scale);
        const Warp& w = domain.warp;
        if (!w.view_volume()) return;
        lower = upper = vec3(0);  // the eye
        if (w.kind == Warp::Kind::spherical) {
            lower = vec3(-w.far), upper = vec3(w.far);
            return;
        }
        for (const float x : {-w.half_x, w.half_x})
            for (const float y : {-w.half_y, w.half_y}) {
                const vec3 corner = (w.forward + w.right * x + w.up * y) * w.far;
                lower = glm::min(lower, corner);
                upper = glm::max(upper, corner);
            }
    }
};

}  // namespace interreflect
