/// Choosing from a list in proportion to weights.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>

namespace interreflect {

/// Turns n weights (in values[1..n]) into a distribution function with values[0] = 0 and values[n] = 1. Returns the sum of the
/// weights; where it is 0 every entry is 0.
inline double make_cdf(std::span<float> values) {
    double sum = 0;
    for (std::size_t i = 1; i < values.size(); ++i) sum += values[i];
    values[0] = 0.0f;
    double running = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        running += values[i];
        values[i] = sum > 0 ? static_cast<float>(running / sum) : 0.0f;
    }
    if (sum > 0) values.back() = 1.0f;
    return sum;
}

/// The entry i with cdf[i] <= u < cdf[i + 1], and where u lies in it, in [0, 1). Entries of weight 0 are never chosen.
struct Chosen {
    std::size_t index;
    float rest;
};
inline Chosen choose_entry(std::span<const float> cdf, float u) {
    const auto above = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, u);
    auto index = static_cast<std::size_t>(above - cdf.begin()) - 1;
    while (index > 0 && cdf[index + 1] <= cdf[index]) --index;  // u at or beyond the last entry of positive weight
    const float width = cdf[index + 1] - cdf[index];
    return {index, width > 0.0f ? std::min((u - cdf[index]) / width, 0x1.fffffep-1f) : 0.0f};
}

}  // namespace interreflect
