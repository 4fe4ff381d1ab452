#include "voxels/march/cone_schedule.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace interreflect {
namespace {

constexpr float longest_step = 2.0f;  // diameters, that `step_growth` leads to

/// Steps as long as a texel, half of one or two must be so exactly: those exponents need no power.
float rounded(float exponent) {
    for (const float simple : {0.5f, 1.0f, 2.0f})
        if (std::fabs(exponent - simple) < 1e-5f * simple) return simple;
    return exponent;
}

/// A schedule as it grows. Lengths in voxels.
class Walk {
  public:
    Walk(const ConeShape& shape, const Pyramid& pyramid, float way)
        : shape_(shape),
          slope_(2.0f * std::tan(shape.half_angle)),
          ratio_(shape.step),
          end_(way),
          coarsest_(static_cast<float>(pyramid.levels.size() - 1)) {}

    /// From where the cone is `diameter` wide, `begin` along it. A cone of half angle 0 still advances: its diameter never
    /// shrinks.
    void widen(float begin, float diameter) {
        float length = ratio_ * diameter;
        float lod = std::log2(diameter) + shape_.level_bias;
        float distance = begin + 0.5f * length;
        while (goes_on(distance)) {
            add(distance, length, lod);
            // A sample stands for the step around it: half of this one and half of the next lie between the two.
            const float growth = 1.0f + slope_ * ratio_;
            const float next = length * growth * stretch();
            distance += 0.5f * (length + next);
            length = next;
            lod += std::log2(growth);
        }
    }
    /// As if one voxel wide, until the cone is; returns where that is.
    float walk_as_ray() {
        float begin = 0;
        while (slope_ * begin < 1.0f && goes_on(begin + 0.5f * ratio_)) {
            add(begin + 0.5f * ratio_, ratio_, shape_.level_bias);
            begin += ratio_;
            stretch();
        }
        return begin;
    }
    void walk_from_apex(float height) {
        while (goes_on(height)) {
            const float diameter = slope_ * height, length = ratio_ * std::max(diameter, shape_.first_diameter);
            add(height, length, std::log2(std::max(diameter, 1.0f)) + shape_.level_bias);
            height += length;
            stretch();
        }
    }
    float diameter(float distance) const { return slope_ * distance; }
    ConeSchedule take() {
        schedule_.opacity_correction = shape_.opacity_correction;
        return std::move(schedule_);
    }

  private:
    bool goes_on(float distance) const {
        return distance < end_ && (shape_.most_steps == 0 || std::ssize(schedule_.steps) < shape_.most_steps);
    }
    /// Lengthens the steps from here on; returns by how much.
    float stretch() {
        const float factor = std::clamp(longest_step / ratio_, 1.0f, shape_.step_growth);
        ratio_ *= factor;
        return factor;
    }
    void add(float distance, float length, float lod) {
        const float level = std::clamp(lod, 0.0f, coarsest_);
        ConeSchedule::Step step{};
        step.distance = distance;
        step.level = static_cast<int>(level);
        step.blend = level - static_cast<float>(step.level);
        step.exponent = shape_.opacity_correction ? rounded(shape_.density * length * std::exp2(-level)) : shape_.density;
        // Near the finest level a texel is as thin as a surface, whose opacity successive taps have a part of each.
        step.correlation = shape_.correlation * std::clamp(lod - 1.0f, 0.0f, 1.0f);
        step.reach = std::exp2(level);
        step.lod = lod;
        step.density = shape_.opacity_correction ? shape_.density * length : shape_.density;
        schedule_.steps.push_back(step);
    }

    ConeShape shape_;
    float slope_;     // diameters a length
    float ratio_;     // of a step to the diameter where it begins
    float end_;       // longer than any way through the domain
    float coarsest_;  // level
    ConeSchedule schedule_;
};

}  // namespace

ConeSchedule make_schedule(const ConeShape& shape, const Pyramid& pyramid) {
    return make_schedule(shape, pyramid, pyramid.domain.longest_way() + 2.0f);
}

ConeSchedule make_schedule(const ConeShape& shape, const Pyramid& pyramid, float way) {
    Walk walk(shape, pyramid, way);
    if (shape.start == ConeShape::Start::height) {
        walk.walk_from_apex(shape.start_height);
    } else if (shape.start == ConeShape::Start::rays) {
        const float begin = walk.walk_as_ray();
        walk.widen(begin, std::max(walk.diameter(begin), 1.0f));
    } else {
        walk.widen(0.0f, shape.first_diameter);
    }
    return walk.take();
}

}  // namespace interreflect
