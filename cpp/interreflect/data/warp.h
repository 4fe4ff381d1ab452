/// A warp in its place: how the voxels of a grid are spread over space.
///
/// p are linear voxels: world space but for an offset and a scale. q are warped voxels: cell (x, y, z) is where q lies in
/// [x, x + 1] x [y, y + 1] x [z, z + 1]. The Jacobian dq/dp is the density of voxels, axis by axis.
#pragma once
#include <cstdint>

#include "math/vectors.h"

namespace interreflect {

struct Warp {
    enum class Kind : std::uint8_t { linear, logistic, cubic, perspective, spherical };
    Kind kind = Kind::linear;
    bool linear_depth = true;  // perspective: depth by distance; else hyperbolic, as a projection matrix leaves it

    // Of the separable ones: where voxels are densest (linear voxels), and how steep the curve is.
    vec3 centre{0};
    float steepness = 0;  // logistic: half its exponent over half the box; cubic: its slope at the centre

    // Of the view volumes: the eye is p = 0. Half angles: tangents (perspective) or radians (spherical); depths: linear voxels.
    vec3 right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};
    float half_x = 1, half_y = 1, near = 1, far = 2, elevation = 0;  // elevation: of the volume's middle, radians

    bool separable() const { return kind <= Kind::cubic; }
    bool view_volume() const { return kind >= Kind::perspective; }

    vec3 to_voxels(const vec3& p, const ivec3& cells) const;
    vec3 to_linear(const vec3& q, const ivec3& cells) const;
    /// Of a separable warp, place and density at once: most of its work is shared.
    struct Slopes {
        vec3 voxels, slopes;
    };
    Slopes slopes_at(const vec3& p, const ivec3& cells) const;
    /// Columns: dq/dp.x, dq/dp.y, dq/dp.z.
    mat3 density(const vec3& p, const ivec3& cells) const;

    bool operator==(const Warp&) const = default;
};

}  // namespace interreflect
