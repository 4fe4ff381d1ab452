/// Sets of cones that stand for the cosine-weighted hemisphere.
#pragma once
#include <string>
#include <vector>

#include "math/vectors.h"

namespace interreflect {

/// Cones about +z, in the frame of the shading normal. Weights sum to 1: irradiance = pi * sum of weight * mean radiance.
struct ConeSet {
    struct Cone {
        vec3 direction;
        float weight;
    };
    std::vector<Cone> cones;
    float half_angle = 0;  // radians, of every cone

    /// sum of weight * mean of cos over the cone: 2/3 where the set integrates radiance ~ cos exactly.
    float mean_cosine() const;
};

/// Five cones of 45 degrees full aperture, one along the normal, four tilted by 45 degrees, equal weights [Freed 2018, 4.5.2].
/// They give .7365 for radiance ~ cos, where 2/3 is right (ERRATA).
ConeSet freed_thesis_cones();
/// Six cones of 60 degrees full aperture, one along the normal with weight 1/4, five tilted by 60 degrees [program of Freed
/// 2018; Crassin et al. 2011].
ConeSet six_60_cones();
/// `count` cones of equal weight: rings of equal projected solid angle, each cone at the mean cosine of its part times a common
/// factor, so that the set integrates radiance ~ cos exactly. half_angle: radians; 0: cones of the hemisphere's solid angle /
/// count.
ConeSet cosine_cones(int count, float half_angle);

}  // namespace interreflect
