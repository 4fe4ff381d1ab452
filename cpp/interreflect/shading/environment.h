/// The environment as a light: look-up, and directions in proportion to luminance.
#pragma once
#include <vector>

#include "data/scene.h"

namespace interreflect {

/// Look-ups are bilinear; a texel's cell is chosen by the mean of the bilinear image over it times its solid angle, and the
/// direction is uniform in the cell's solid angle, so the density is positive wherever there is light.
class EnvironmentSampler {
  public:
    /// null: no environment. The environment must outlive the sampler.
    explicit EnvironmentSampler(const Environment* environment);

    bool present() const { return environment_ != nullptr; }
    bool constant() const { return environment_ != nullptr && environment_->width == 0; }
    vec3 radiance(const vec3& direction) const;
    vec3 sample(const vec2& u) const;
    float pdf(const vec3& direction) const;

  private:
    int row_of(const vec3& local) const;
    int column_of(const vec3& local) const;
    vec3 texel(int x, int y) const { return environment_->image[static_cast<std::size_t>(y) * environment_->width + x]; }
    void build_table();

    const Environment* environment_;
    bool black_ = true;
    std::vector<float> row_cdf_;     // height + 1
    std::vector<float> column_cdf_;  // height x (width + 1)
    std::vector<float> row_cosine_;  // height + 1: cosine from up at the rows' borders
};

}  // namespace interreflect
