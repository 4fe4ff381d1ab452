#include "surfels/cluster/kd_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace interreflect {
namespace {

/// A place and a normal as one point: the square of two points' distance is the paper's without its balance term, since
/// |n - n'|^2 = 2 (1 - n . n').
using Point = std::array<float, 6>;

class Halving {
  public:
    Halving(const KdTree& technique, const Surfels& surfels) : points_(surfels.size()), order_(surfels.size()) {
        const float place = surfels.extent > 0.0f ? 1.0f / surfels.extent : 1.0f;
        const float turn = std::sqrt(0.5f * static_cast<float>(technique.normal_weight));
        for (std::size_t i = 0; i < points_.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                points_[i][static_cast<std::size_t>(k)] = surfels.position[i][k] * place;
                points_[i][static_cast<std::size_t>(k) + 3] = surfels.normal[i][k] * turn;
            }
        std::iota(order_.begin(), order_.end(), 0U);
        merges_.reserve(order_.size());
        if (!order_.empty()) build(0, order_.size());
    }
    std::span<const Merge> merges() const { return merges_; }

  private:
    std::uint32_t build(std::size_t begin, std::size_t end) {
        if (end - begin == 1) return order_[begin];
        const std::size_t axis = widest(begin, end), middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const float x = points_[a][axis], y = points_[b][axis];
            return x != y ? x < y : a < b;
        });
        const std::uint32_t left = build(begin, middle), right = build(middle, end);
        merges_.push_back({left, right});
        return static_cast<std::uint32_t>(order_.size() + merges_.size() - 1);
    }
    std::size_t widest(std::size_t begin, std::size_t end) const {
        Point low, high;
        low.fill(std::numeric_limits<float>::infinity()), high.fill(-std::numeric_limits<float>::infinity());
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t k = 0; k < low.size(); ++k) {
                low[k] = std::min(low[k], points_[order_[i]][k]);
                high[k] = std::max(high[k], points_[order_[i]][k]);
            }
        std::size_t axis = 0;
        for (std::size_t k = 1; k < low.size(); ++k)
            if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
        return axis;
    }

    std::vector<Point> points_;
    std::vector<std::uint32_t> order_;
    std::vector<Merge> merges_;
};

}  // namespace

ClusteredSurfels cluster_surfels(const KdTree& technique, const Surfels& surfels) {
    const Halving halving(technique, surfels);
    return in_post_order(surfels, halving.merges());
}

}  // namespace interreflect
