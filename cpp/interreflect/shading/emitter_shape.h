/// Emitters few enough to be weighed anew from every point, as vector kernels read them.
#pragma once
#include <cstdint>
#include <span>

#include "math/vectors.h"

namespace interreflect {

struct LightDirection;

/// Up to so many shapes are weighed anew from every point: their solid angles cost less than the shadow ray they save.
inline constexpr int most_weighed = 16;

/// A triangle of one radiance, or the rectangle that two of them make.
struct EmitterShape {
    vec3 corner, edge1, edge2, normal;  // world space; the normal of the side that emits
    vec3 to_middle;                     // from the corner
    float area = 0, luminance = 0;
    float near2 = 0;  // squared distance of the middle below which the solid angle itself is sampled
    vec3 emission{0};
    bool rectangle = false;
};

/// One point of a shape in proportion to luminance times solid angle, seen from `position`; near by uniform in the solid angle,
/// far away in the area, where the light varies little and spherical angles lose their digits.
LightDirection sample_shapes(std::span<const EmitterShape> shapes, const vec3& position, float choose, const vec2& u);
/// Solid angle density of sample_shapes for a point of shape number `which` in direction `direction`.
float shapes_pdf(std::span<const EmitterShape> shapes, const vec3& position, const vec3& direction, int which);

}  // namespace interreflect
