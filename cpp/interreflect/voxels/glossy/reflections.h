/// Pixels whose glossy lobes send cones together.
#pragma once
#include "data/gbuffer.h"
#include "voxels/glossy/lobe_table.h"
#include "voxels/march/march_cones.h"

namespace interreflect {

struct Reflections {
    static constexpr int capacity = ConeBatch::capacity;

    int count = 0;
    std::size_t pixel[capacity];
    // World space position and shading normal, as the G-buffer has them; the entry with which the lobe's table begins.
    alignas(64) float position[3][capacity], normal[3][capacity], alpha[capacity];
    alignas(64) std::int32_t table[capacity];
    // The lobe's cone: unit direction in world space, radians, and LobeCone's scale and bias.
    alignas(64) float direction[3][capacity], half_angle[capacity], scale[capacity], bias[capacity];
    // What it sees, before the lobe's albedo.
    vec3 radiance[capacity], sky[capacity];

    void add(const GBuffer& g, const LobeTables& tables, std::size_t at) {
        const int i = count++;
        pixel[i] = at;
        for (int k = 0; k < 3; ++k) position[k][i] = g.position[at][k], normal[k][i] = g.normal[at][k];
        alpha[i] = g.alpha[at];
        table[i] = tables.first(at);
    }
    vec3 cone(int i) const { return {direction[0][i], direction[1][i], direction[2][i]}; }
    vec3 albedo(int i, const vec3& specular) const { return specular * scale[i] + (vec3(1) - specular) * bias[i]; }
};

/// Finds the cones of all lobes as they are seen from `eye`. `mirrored`: about the mirrored view, else about the lobe's mean.
void find_lobes(const LobeTables& tables, const vec3& eye, bool mirrored, Reflections& of);

}  // namespace interreflect
