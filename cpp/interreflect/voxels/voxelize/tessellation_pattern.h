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

/// Calls `row(start, along, count, share)` for the rows of vertices of the pattern of triangles with equal spacing
/// [OpenGL 4.6 core, 11.2.2.1]: barycentric weights start + along * j for j in [0, count), each vertex standing for `share` of
/// the triangle's area.
///
/// Concentric triangles lie 2 / (3 inner) of an altitude apart; their edges have inner, inner - 2, ... parts, down to one part or
/// the centre. The edges of the outermost are cut by the outer levels instead. A triangle's vertices share the area halfway to
/// the next triangle inwards and outwards, each edge's a third of it: all shares sum to 1.
template <class Row>
void tessellation_rows(const TessellationLevels& levels, const Row& row) {
    const auto corner = [](int i, float inset) {  // of the triangle whose edges keep `inset` of the altitude from the border
        vec3 weights(inset);
        weights[i] = 1.0f - 2.0f * inset;
        return weights;
    };
    // With more than one part at the border there is a centre.
    const int inner = levels.inner == 1 && !levels.whole() ? 2 : levels.inner;
    const auto n = static_cast<float>(inner);
    const auto area_inside = [n](float rings) {  // of the triangle so many rings inside
        const float edge = 1.0f - 2.0f * rings / n;
        return edge > 0.0f ? edge * edge : 0.0f;
    };
    for (int side = 0; side < 3; ++side) {
        for (int ring = 0; 2 * ring < inner; ++ring) {
            const int parts = ring == 0 ? levels.outer[side] : inner - 2 * ring;
            const float inset = 2.0f * static_cast<float>(ring) / (3.0f * n);
            const vec3 start = corner(side, inset), end = corner((side + 1) % 3, inset);
            const auto k = static_cast<float>(ring);
            // The innermost, an edge of one part, stands for all that it encloses.
            const float enclosed = 2 * ring + 1 == inner ? 0.0f : area_inside(k + 0.5f);
            const float area = (ring == 0 ? 1.0f : area_inside(k - 0.5f)) - enclosed;
            row(start, (end - start) / static_cast<float>(parts), parts, area / static_cast<float>(3 * parts));
        }
    }
    if (inner % 2 == 0) row(vec3(1.0f / 3.0f), vec3(0), 1, area_inside(0.5f * n - 0.5f));
}

}  // namespace interreflect
