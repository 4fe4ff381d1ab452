/// Directions spread evenly over the sphere.
#pragma once
#include <cmath>

#include "math/vectors.h"

namespace interreflect {

/// Direction k of n: a spiral of equal areas with the golden angle between neighbours.
inline vec3 spiral(int k, int n) {
    const float z = 1.0f - (2.0f * static_cast<float>(k) + 1.0f) / static_cast<float>(n);
    const float r = std::sqrt(std::fmax(1.0f - z * z, 0.0f));
    const double turns = 0.3819660112501051 * k;
    const auto angle = static_cast<float>(6.283185307179586 * (turns - std::floor(turns)));
    return {r * std::cos(angle), r * std::sin(angle), z};
}

}  // namespace interreflect
