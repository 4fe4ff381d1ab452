/// Three axes for the normals of a tile [Rehfeld et al. 2014, 3.2, "Adapting to Normals"].
#pragma once
#include <array>
#include <span>
#include <vector>

#include "math/octahedral_map.h"

namespace interreflect {

/// A histogram of normals over the sphere is smoothed by a Gaussian, and its bins are rated as shares of the fullest, lest the
/// outcome depend on how many pixels a tile has; the bin rated highest gives an axis, and
/// w = (w + 1) (1 - |n . n_best|^exponent) lowers what is collinear with it, for the next one. The 1 makes bins that no normal is
/// in gain, orthogonal ones most: that is what spreads the later axes where few normals ask for them (ERRATA: not purely
/// decreasing, and blind to the sign: whoever uses the axes must tell their two ends apart).
class NormalAxes {
  public:
    /// bins: on a side of the octahedral map; smoothing: standard deviation, radians.
    NormalAxes(int bins, float smoothing, float exponent);

    int count() const { return bins_ * bins_; }
    int bins() const { return bins_; }
    /// The axes of how many normals each bin (count_normals) holds.
    std::array<vec3, 3> choose(std::span<const float> histogram) const;

  private:
    int bins_;
    std::vector<vec3> directions_;
    std::vector<float> smooth_;  // row by row: what each bin gives to others; rows add up to 1
    std::vector<float> lower_;   // 1 - |n . m|^exponent of two bins
};

}  // namespace interreflect
