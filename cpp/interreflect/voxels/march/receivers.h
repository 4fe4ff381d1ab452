/// The pixels that send diffuse cones together: what depends on a cone's direction is linear in it, and kept per axis.
#pragma once
#include "voxels/march/march_cones.h"

namespace interreflect {

struct Receivers {
    static constexpr int capacity = ConeBatch::capacity;

    int count = 0;
    int pixel[capacity];
    // World space position, geometric and shading normal, as the G-buffer has them.
    alignas(64) float position[3][capacity], facing[3][capacity], normal[3][capacity];
    alignas(64) float per_axis[3][3][capacity];  // of a direction's x, y, z: by tangent, bitangent and normal
    alignas(64) float sum[7][capacity];          // radiance, openness, sky

    void add(int at, const vec3& where, const vec3& geometric, const vec3& shading) {
        const int i = count++;
        pixel[i] = at;
        for (int k = 0; k < 3; ++k) position[k][i] = where[k], facing[k][i] = geometric[k], normal[k][i] = shading[k];
    }
};

/// Fills `per_axis` of all receivers and the starts of their cones, as set_start does, and clears their sums.
void start_receivers(const Domain& domain, float normal_offset, bool see_own_surface, Receivers& receivers, ConeBatch& batch);

}  // namespace interreflect
