/// Which spheres reach a place? A bounding volume hierarchy over many, built once; queries are const and thread safe.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "math/vectors.h"

namespace interreflect {

class SphereHierarchy {
  public:
    /// As many radii as centres, all finite. Those of radius 0 are points.
    SphereHierarchy(std::span<const vec3> centres, std::span<const float> radii);
    ~SphereHierarchy();
    SphereHierarchy(const SphereHierarchy&) = delete;
    SphereHierarchy& operator=(const SphereHierarchy&) = delete;

    /// Numbers of the spheres that come within `distance` of a point, in ascending order; up to rounding, some that just do not.
    void reach(const vec3& point, float distance, std::vector<std::uint32_t>& found) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace interreflect
