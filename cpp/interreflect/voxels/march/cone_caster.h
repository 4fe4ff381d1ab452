/// Single cones from surfaces in world space, towards lights or about a normal.
#pragma once
#include <limits>
#include <span>
#include <vector>

#include "data/counts.h"
#include "voxels/march/march_cones.h"
#include "voxels/march/march_knobs.h"

namespace interreflect {

/// Cones of one half angle through one pyramid.
class ConeCaster {
  public:
    struct Cone {
        vec3 position, normal;  // of the surface, world space; unit, on the side where the cone goes
        vec3 direction;         // unit
        float distance = std::numeric_limits<float>::infinity();  // to a light; the cone's filter ends a voxel before it
    };

    /// half_angle: radians. The pyramid must outlive it.
    ConeCaster(const Pyramid& pyramid, const MarchKnobs& knobs, float half_angle);

    /// Marches up to ConeBatch::capacity cones; radiance (in the pyramid's unit) and openness are in the batch.
    Counts cast(std::span<const Cone> cones, ConeBatch& batch) const;

  private:
    const Pyramid& pyramid_;
    MarchKnobs knobs_;
    ConeSchedule schedule_;
    AirMap air_;
};

/// Shadow cones through several pyramids, whose transmittances are multiplied [Rehfeld et al. 2014, 3.1 and 5].
class ShadowCones {
  public:
    ShadowCones(std::span<const Pyramid* const> pyramids, const MarchKnobs& knobs, float half_angle);

    /// Which share of each of up to ConeBatch::capacity cones nothing blocks.
    Counts open(std::span<const ConeCaster::Cone> cones, std::span<float> share) const;

  private:
    std::vector<ConeCaster> casters_;
};

}  // namespace interreflect
