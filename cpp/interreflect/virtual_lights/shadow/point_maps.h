/// The drawing of surface points into paraboloid maps of virtual lights, and the filling of their holes.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "math/vectors.h"

namespace interreflect {

/// A point of the scene where it is now: a disk of surface.
struct WorldPoint {
    vec3 position, normal;  // unit
};

/// One light's map: radial distances, infinite where nothing was drawn.
class PointMap {
  public:
    /// `depth`: size x size texels; `directions`: of their centres (paraboloid_directions).
    PointMap(std::span<float> depth, std::span<const vec3> directions, int size, const vec3& position, const vec3& normal);

    /// Draws a disk of surface at the depth of its plane; one that no texel's middle sees is drawn as its middle's texel.
    void draw_disk(const WorldPoint& point, float radius);
    /// Draws a square of one depth as large as the disk.
    void draw_square(const WorldPoint& point, float radius);

  private:
    struct Place {
        vec3 local;  // in the light's frame
        float distance;
        int x, y;            // texel
        int x0, x1, y0, y1;  // texels that it may cover, inclusive
        bool above;          // the light's horizon
    };
    Place place(const WorldPoint& point, float radius) const;

    std::span<float> depth_;
    std::span<const vec3> directions_;
    int size_;
    vec3 origin_;
    Frame frame_;
};

std::vector<vec3> paraboloid_directions(int size);

/// Fills empty texels of a map from the mean of coarser levels' texels that are not, so many levels up [Ritschel et al. 2008].
struct Filled {
    std::uint64_t empty, filled;  // texels above the horizon
};
Filled pull_push(std::span<float> depth, int size, int levels, std::span<const vec3> directions);

}  // namespace interreflect
