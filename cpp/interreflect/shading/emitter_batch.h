/// Light samples of up to sixteen points at once: as wide as the machine's vectors.
#pragma once
#include "shading/lights.h"

namespace interreflect {

struct EmitterBatch {
    static constexpr int width = 16;
    int count = 0;
    alignas(64) float position[3][width], choose[width], u[width], v[width];
    LightDirection light[width];

    void add(const vec3& at, float choice, const vec2& point) {
        for (int axis = 0; axis < 3; ++axis) position[axis][count] = at[axis];
        choose[count] = choice, u[count] = point.x, v[count] = point.y;
        ++count;
    }
};

/// LightSampler::sample_emitter for every entry of the batch, into `light`.
void sample_emitters(const LightSampler& lights, EmitterBatch& batch);

}  // namespace interreflect
