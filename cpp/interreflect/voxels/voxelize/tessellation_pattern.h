/// The vertices of a tessellated triangle.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "math/vectors.h"

namespace interreflect {

/// Parts that the edges of a triangle, and those of the first triangle inside it, are cut into.
struct TessellationLevels {
    std::array<int, 3> outer{1, 1, 1};  // of the edge from corner i to corner i + 1
    int inner = 1;

    bool whole() const { return outer == std::array<int, 3>{1, 1, 1} && inner == 1; }
};

/// The concentric triangles of an inner level.
struct TessellationRings {
    int inner;

    explicit TessellationRings(int level) : inner(level) {}
    explicit TessellationRings(const TessellationLevels& levels)  // with more than one part at the border there is a centre
        : inner(levels.inner == 1 && !levels.whole() ? 2 : levels.inner) {}

    /// Of the triangle so many rings inside: its share of the area.
    float area_inside(float rings) const {
        const float edge = 1.0f - 2.0f * rings / static_cast<float>(inner);
        return edge > 0.0f ? edge * edge : 0.0f;
    }
    /// The vertices along one side of a ring.
    template <class Row>
    void side(int ring, int side, int parts, const Row& row) const {
        const float inset = 2.0f * static_cast<float>(ring) / (3.0f * static_cast<float>(inner));
        const vec3 start = corner(side, inset), end = corner((side + 1) % 3, inset);
        const auto k = static_cast<float>(ring);
        // The innermost, an edge of one part, stands for all that it encloses.
        const float enclosed = 2 * ring + 1 == inner ? 0.0f : area_inside(k + 0.5f);
        const float area = (ring == 0 ? 1.0f : area_inside(k - 0.5f)) - enclosed;
        row(start, (end - start) / static_cast<float>(parts), parts, area / static_cast<float>(3 * parts));
    }

  private:
    static vec3 corner(int i, float inset) {  // of the triangle whose edges keep `inset` of the altitude from the border
        vec3 weights(inset);
        weights[i] = 1.0f - 2.0f * inset;
        return weights;
    }
};

/// The vertices on the border: see tessellation_rows.
template <class Row>
void tessellation_outer_rows(const TessellationLevels& levels, const Row& row) {
    const TessellationRings rings(levels);
    for (int side = 0; side < 3; ++side) rings.side(0, side, levels.outer[side], row);
}
/// Those inside, which depend on the inner level alone.
template <class Row>
void tessellation_inner_rows(int inner, const Row& row) {
    const TessellationRings rings(inner);
    for (int ring = 1; 2 * ring < inner; ++ring)
        for (int side = 0; side < 3; ++side) rings.side(ring, side, inner - 2 * ring, row);
    if (inner % 2 == 0) row(vec3(1.0f / 3.0f), vec3(0), 1, rings.area_inside(0.5f * static_cast<float>(inner) - 0.5f));
}

/// Calls `row(start, along, count, share)` for the rows of vertices of the pattern of triangles with equal spacing
/// [OpenGL 4.6 core, 11.2.2.1]: barycentric weights start + along * j for j in [0, count), each vertex standing for `share` of
/// the triangle's area.
///
/// Concentric triangles lie 2 / (3 inner) of an altitude apart; their edges have inner, inner - 2, ... parts, down to one part or
/// the centre. The edges of the outermost are cut by the outer levels instead. A triangle's vertices share the area halfway to
/// the next triangle inwards and outwards, each edge's a third of it: all shares sum to 1.
template <class Row>
void tessellation_rows(const TessellationLevels& levels, const Row& row) {
    tessellation_outer_rows(levels, row);
    tessellation_inner_rows(TessellationRings(levels).inner, row);
}

}  // namespace interreflect
