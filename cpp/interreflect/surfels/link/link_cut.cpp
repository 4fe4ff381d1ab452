#include "surfels/link/link_cut.h"

#include <algorithm>

namespace interreflect {

std::span<const std::uint32_t> LinkCut::choose(std::span<const float> solid_angle, int most) {
    for (std::uint32_t i = 0; i < tree_.nodes(); ++i)
        solid_angle_[i] = tree_.leaves[i] == 1 ? solid_angle[tree_.leaf_end[i] - 1]
                                               : solid_angle_[tree_.left(i)] + solid_angle_[tree_.right(i)];
    open_.clear(), chosen_.clear();
    const auto lower = [this](std::uint32_t a, std::uint32_t b) { return before(a, b); };
    const auto take = [&](std::uint32_t node) {
        if (!(solid_angle_[node] > 0.0f)) return;
        if (tree_.leaves[node] == 1) {
            chosen_.push_back(node);
        } else {
            open_.push_back(node);
            std::ranges::push_heap(open_, lower);
        }
    };
    if (tree_.nodes() > 0) take(static_cast<std::uint32_t>(tree_.nodes() - 1));
    while (!open_.empty() && chosen_.size() + open_.size() < static_cast<std::size_t>(most)) {
        std::ranges::pop_heap(open_, lower);
        const std::uint32_t node = open_.back();
        open_.pop_back();
        take(tree_.left(node)), take(tree_.right(node));
    }
    chosen_.insert(chosen_.end(), open_.begin(), open_.end());
    std::ranges::sort(chosen_);
    return chosen_;
}

}  // namespace interreflect
