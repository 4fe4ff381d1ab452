/// The vertices inside tessellated triangles, worked out once.
#pragma once
#include <array>
#include <vector>

#include "voxels/voxelize/sample_sums.h"
#include "voxels/voxelize/tessellation_pattern.h"

namespace interreflect {

/// Of all inner levels up to the most that graphics processors have: the vertices that do not lie on the border, each with the
/// weights of the second and third corner and its share of the area.
class InnerVertices {
  public:
    static constexpr int most_level = 64;

    InnerVertices() {
        for (int inner = 1; inner <= most_level; ++inner) {
            first_[inner] = static_cast<int>(second_.size());
            tessellation_inner_rows(inner, [this](const vec3& start, const vec3& along, int count, float share) {
                for (int j = 0; j < count; ++j) {
                    const vec3 weights = start + along * static_cast<float>(j);
                    second_.push_back(weights.y), third_.push_back(weights.z), share_.push_back(share);
                }
            });
            first_[inner + 1] = static_cast<int>(second_.size());
        }
        for (auto* values : {&second_, &third_, &share_}) values->resize(values->size() + SampleSums::spare);
    }
    int count(int inner) const { return first_[inner + 1] - first_[inner]; }
    /// From the i-th one on; `area`: of the triangle.
    SampleWeights weights(int inner, int i, float area) const {
        const int at = first_[inner] + i;
        return {second_.data() + at, third_.data() + at, share_.data() + at, area};
    }

  private:
    std::array<int, most_level + 2> first_{};
    std::vector<float> second_, third_, share_;
};

}  // namespace interreflect
