#include "voxels/march/cone_schedule.h"

#include <algorithm>
#include <cmath>

namespace interreflect {

ConeSchedule make_schedule(const ConeShape& shape, const Pyramid& pyramid) {
    const float diagonal = pyramid.domain.longest_way();
    const auto coarsest = static_cast<float>(pyramid.levels.size() - 1);
    // A cone of half angle 0 must still advance: its diameter is at least that of its start.
    const float growth = 1.0f + 2.0f * std::tan(shape.half_angle) * shape.step;
    float length = shape.step * shape.first_diameter;
    float lod = std::log2(shape.first_diameter) + shape.level_bias;
    const float lod_growth = std::log2(growth);

    ConeSchedule schedule;
    float distance = 0.5f * length;
    while (distance < diagonal + 2.0f) {
        const float level = std::clamp(lod, 0.0f, coarsest);
        ConeSchedule::Step step{};
        step.distance = distance;
        step.level = static_cast<int>(level);
        step.blend = level - static_cast<float>(step.level);
        step.exponent = shape.density * length * std::exp2(-level);
        // Near the finest level a texel is as thin as a surface, whose opacity successive taps have a part of each.
        step.correlation = shape.correlation * std::clamp(lod - 1.0f, 0.0f, 1.0f);
        step.reach = std::exp2(level);
        step.lod = lod;
        step.density = shape.density * length;
        schedule.steps.push_back(step);
        // A sample stands for the step around it: half of this one and half of the next lie between the two.
        const float next = length * growth;
        distance += 0.5f * (length + next);
        length = next;
        lod += lod_growth;
    }
    return schedule;
}

}  // namespace interreflect
