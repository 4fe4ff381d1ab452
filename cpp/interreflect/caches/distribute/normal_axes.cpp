#include "caches/distribute/normal_axes.h"

#include <algorithm>
#include <cmath>

#include "caches/distribute/tile_kernels.h"

namespace interreflect {

NormalAxes::NormalAxes(int bins, float smoothing, float exponent) : bins_(bins) {
    for (int y = 0; y < bins; ++y)
        for (int x = 0; x < bins; ++x)
            directions_.push_back(
                octahedral_direction((vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f) / static_cast<float>(bins)));
    const auto n = directions_.size();
    smooth_.resize(n * n), lower_.resize(n * n);
    for (std::size_t i = 0; i < n; ++i) {
        float sum = 0;
        for (std::size_t j = 0; j < n; ++j) {
            const float cosine = std::clamp(glm::dot(directions_[i], directions_[j]), -1.0f, 1.0f), angle = std::acos(cosine);
            smooth_[i * n + j] = i == j             ? 1.0f
                                 : smoothing > 0.0f ? std::exp(-0.5f * angle * angle / (smoothing * smoothing))
                                                    : 0.0f;
            lower_[i * n + j] = i == j ? 0.0f : 1.0f - std::pow(std::fabs(cosine), exponent);
            sum += smooth_[i * n + j];
        }
        for (std::size_t j = 0; j < n; ++j) smooth_[i * n + j] /= sum;
    }
}

std::array<vec3, 3> NormalAxes::choose(std::span<const float> histogram) const {
    const auto n = directions_.size();
    thread_local std::vector<float> rating;
    rating.assign(with_room(n), 0.0f);
    for (std::size_t i = 0; i < n; ++i)
        if (histogram[i] > 0.0f)
            for (std::size_t j = 0; j < n; ++j) rating[j] += histogram[i] * smooth_[i * n + j];
    const float most = rating[first_largest(rating.data(), n)];
    if (most > 0.0f)
        for (std::size_t j = 0; j < n; ++j) rating[j] /= most;
    std::array<vec3, 3> axes;
    for (auto& axis : axes) {
        const std::size_t best = first_largest(rating.data(), n);
        axis = directions_[best];
        const float* lower = lower_.data() + best * n;
        for (std::size_t j = 0; j < n; ++j) rating[j] = (rating[j] + 1.0f) * lower[j];
    }
    return axes;
}

}  // namespace interreflect
