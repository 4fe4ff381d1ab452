/// Single cones from surfaces in world space, towards lights or about a normal, through one hierarchy or several.
#pragma once
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "data/counts.h"
#include "voxels/march/hierarchies.h"
#include "voxels/march/march_knobs.h"

namespace interreflect {

/// Cones of one half angle. Of several hierarchies, each is marched in its own space, and what a cone sees in them is put in
/// order by HitOrder. Lengths of the knobs are in voxels of the hierarchy that a cone's surface belongs to, as only that one's
/// voxels have the surface's plane in them to be taken out.
class ConeCaster {
  public:
    struct Cone {
        vec3 position, normal;  // of the surface, world space; unit, on the side where the cone goes
        vec3 direction;         // unit
        float distance = std::numeric_limits<float>::infinity();  // to a light; the cone's filter ends a voxel before it
        std::uint32_t body = 0;                                   // of the surface
    };

    /// half_angle: radians. The pyramids must outlive it.
    ConeCaster(Pyramids pyramids, const MarchKnobs& knobs, float half_angle);
    ConeCaster(std::shared_ptr<const Hierarchies> hierarchies, const MarchKnobs& knobs, float half_angle);

    /// Marches up to ConeBatch::capacity cones; directions (world space), radiance (in the first pyramid's unit) and openness are
    /// in the batch.
    Counts cast(std::span<const Cone> cones, ConeBatch& batch) const;

  private:
    struct Start {
        vec3 position, direction;  // of a cone, world space
    };
    Counts cast_alone(std::span<const Cone> cones, ConeBatch& batch) const;
    Counts cast_through(int part, std::uint32_t owner, std::span<const Cone> cones, std::span<const std::size_t> chosen,
                        ConeBatch& batch) const;
    Start start_of(const Cone& cone, int from) const;
    const ConeSchedule& schedule(int part, int from) const;

    std::shared_ptr<const Hierarchies> hierarchies_;
    MarchKnobs knobs_;
    // Of hierarchy i, cones that start with voxels `ratio` times as large as its own.
    struct Schedule {
        float ratio;
        ConeSchedule steps;
    };
    std::vector<std::vector<Schedule>> schedules_;
};

/// Shadow cones through several pyramids, whose transmittances are multiplied [Rehfeld et al. 2014, 3.1 and 5].
class ShadowCones {
  public:
    ShadowCones(Pyramids pyramids, const MarchKnobs& knobs, float half_angle) : caster_(pyramids, knobs, half_angle) {}

    /// Which share of each of up to ConeBatch::capacity cones nothing blocks.
    Counts open(std::span<const ConeCaster::Cone> cones, std::span<float> share) const;

  private:
    ConeCaster caster_;
};

}  // namespace interreflect
