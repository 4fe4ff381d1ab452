/// Convex polygons: triangles cut by the faces of cells.
#pragma once
#include <array>

#include "math/vectors.h"

namespace interreflect {

/// A convex polygon: a triangle cut by six planes has at most nine corners.
struct Polygon {
    std::array<vec3, 10> corner;
    int count = 0;
};

/// The part of a polygon where position[axis] * sign <= bound, sign being 1 or -1.
inline Polygon cut(const Polygon& polygon, int axis, float sign, float bound) {
    Polygon inside;
    for (int i = 0; i < polygon.count; ++i) {
        const vec3& a = polygon.corner[i];
        const vec3& b = polygon.corner[(i + 1) % polygon.count];
        const float da = bound - sign * a[axis], db = bound - sign * b[axis];
        if (da >= 0.0f) inside.corner[inside.count++] = a;
        if ((da > 0.0f && db < 0.0f) || (da < 0.0f && db > 0.0f)) {
            vec3 crossing = a + (b - a) * (da / (da - db));
            crossing[axis] = sign * bound;
            inside.corner[inside.count++] = crossing;
        }
    }
    return inside;
}

/// The part between two planes across an axis.
inline Polygon between(const Polygon& polygon, int axis, float lower, float upper) {
    return cut(cut(polygon, axis, 1.0f, upper), axis, -1.0f, -lower);
}

}  // namespace interreflect
