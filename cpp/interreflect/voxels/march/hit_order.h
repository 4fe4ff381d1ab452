/// What one cone sees in several hierarchies, put in order.
#pragma once
#include <utility>

#include "math/vectors.h"
#include "voxels/march/march_cones.h"

namespace interreflect {

/// "We repeat casting of the same ray for all hierarchies in the scene, and when we find a second (or n-th) hit, we order the
/// current and the new hit according to their depth and blend between their results in the correct back-to-front order. This
/// yields correct results for shadowing, as shadows from different hierarchies can be multiplied commutatively, and semi-correct
/// results for radiance accumulation [...]. If there is a third hit in yet another hierarchy, blending might introduce a small
/// error: we save hit information only for the closest hit, so we cannot blend correctly if new hits lie between the previous
/// hits. Instead these hits are simply blended behind." [Rehfeld et al. 2014, 3.1]
///
/// Here the depths of the two nearest hits are kept, so three hits are always in order; of more, those beyond the two nearest are
/// blended in the order they are found. A hit is all that a cone sees in one hierarchy, at the mean depth of what blocks it.
class HitOrder {
  public:
    void add(const vec3& radiance, float open, float depth) {
        Hit hit{radiance, open, depth};
        if (hit.depth < nearest_.depth) std::swap(hit, nearest_);
        const bool nearer = hit.depth < second_.depth;
        if (nearer) std::swap(hit, second_);
        // What was pushed back lies before all that is behind it already.
        if (nearer || open_behind_ == 1.0f)
            behind_ = hit.radiance + hit.open * behind_;
        else
            behind_ += open_behind_ * hit.radiance;
        open_behind_ *= hit.open;
    }
    vec3 radiance() const { return nearest_.radiance + nearest_.open * (second_.radiance + second_.open * behind_); }
    /// Transmittances multiply, in any order.
    float open() const { return nearest_.open * second_.open * open_behind_; }

  private:
    struct Hit {
        vec3 radiance{0};
        float open = 1.0f, depth = nothing_there;
    };
    Hit nearest_, second_;
    vec3 behind_{0};
    float open_behind_ = 1.0f;
};

}  // namespace interreflect
