/// The voxel hierarchies of a scene's parts, as cones march through them.
#pragma once
#include <vector>

#include "voxels/march/march_cones.h"

namespace interreflect {

class Hierarchies {
  public:
    /// Pyramids of what stands still and of bodies; they must outlive it.
    explicit Hierarchies(Pyramids pyramids);

    int count() const { return static_cast<int>(parts_.size()); }
    const Pyramid& pyramid(int i) const { return *parts_[static_cast<std::size_t>(i)].pyramid; }
    const AirMap& air(int i) const { return parts_[static_cast<std::size_t>(i)].air; }
    /// One hierarchy of everything, in world space.
    bool alone() const { return count() == 1 && pyramid(0).pose.body == 0; }
    /// The body whose hierarchies a receiver on `body` belongs to: itself, or, where it has none of its own, the world.
    std::uint32_t owner(std::uint32_t body) const;
    /// The first hierarchy of an owner.
    int first_of(std::uint32_t owner) const;
    /// Longer than any way from within one hierarchy through hierarchy `i`, its voxels.
    float longest_way(int i) const { return parts_[static_cast<std::size_t>(i)].longest_way; }

  private:
    struct Part {
        const Pyramid* pyramid;
        AirMap air;
        float longest_way;
    };
    std::vector<Part> parts_;
};

}  // namespace interreflect
