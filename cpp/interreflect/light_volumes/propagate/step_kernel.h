/// What a row of cells gets of all its neighbours, a vector of cells at a time.
#pragma once
#include <cstddef>

#include "light_volumes/propagate/planes.h"

namespace interreflect {

struct StepRow {
    const float* before[Planes::count];  // the row's own cells, before the step
    float* after[Planes::count];
    float* sum[Planes::count];    // what comes is added here
    std::ptrdiff_t step[3];       // to the next cell along each axis
    const float* faces[3][4];     // what blocks light into them, across each axis (FaceBlockers); null: nothing
    std::ptrdiff_t face_step[3];  // to the faces behind
    int cells;
    bool clamps;  // whether flux below 0 is 0
};
void step_row(const StepRow& row);

}  // namespace interreflect
