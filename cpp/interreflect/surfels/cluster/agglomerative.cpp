#include "surfels/cluster/agglomerative.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <stdexcept>
#include <vector>

#include "math/parallel.h"
#include "surfels/cluster/patch_search.h"

namespace interreflect {
namespace {

/// The patch nearest to `owner` when it was looked for. Patches that have gone since only make the true distance larger, and
/// those that have come have candidates of their own.
struct Candidate {
    float distance;
    std::uint32_t owner, other;

    std::uint32_t lower() const { return std::min(owner, other); }
    std::uint32_t higher() const { return std::max(owner, other); }
    /// For queues whose top is the largest. Ties as PatchSearch breaks them.
    bool operator<(const Candidate& c) const {
        if (distance != c.distance) return distance > c.distance;
        const std::uint32_t mine = gap(owner, other), its = gap(c.owner, c.other);
        return mine != its ? mine > its : lower() > c.lower();
    }
};

const Patch& finite(const Patch& p) {
    // No two of such places are further apart than a float can tell.
    if (!std::isfinite(4.0f * glm::dot(p.position, p.position) + glm::dot(p.normal, p.normal) + p.area))
        throw std::invalid_argument("surfels to be clustered must have finite places, normals and areas");
    return p;
}

class Merging {
  public:
    Merging(const Agglomerative& technique, const Surfels& surfels)
        : metric_{static_cast<float>(technique.normal_weight), static_cast<float>(technique.balance_weight)},
          count_(surfels.size()) {
        patches_.reserve(2 * count_);
        for (std::size_t i = 0; i < count_; ++i) patches_.push_back(finite(patch_of(surfels, i)));
        heights_.assign(count_, 0.0f);
        rebuild();
        std::vector<Candidate> candidates(count_ > 1 ? count_ : 0);
        parallel_blocks(candidates.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) candidates[i] = candidate(static_cast<std::uint32_t>(i));
        });
        queue_ = std::priority_queue<Candidate>({}, std::move(candidates));
    }
    void run() {
        while (merges_.size() + 1 < count_) {
            const Candidate next = queue_.top();
            queue_.pop();
            if (!search_->contains(next.owner)) continue;
            if (search_->contains(next.other))
                merge(next);
            else
                queue_.push(candidate(next.owner));
        }
    }
    std::span<const Merge> merges() const { return merges_; }
    std::uint64_t inversions() const { return inversions_; }

  private:
    Candidate candidate(std::uint32_t number) const {
        const NearestPatch found = search_->nearest(patches_[number], number);
        return {found.distance, number, found.number};
    }
    void merge(const Candidate& pair) {
        const std::uint32_t a = pair.lower(), b = pair.higher(), made = static_cast<std::uint32_t>(patches_.size());
        if (made % 1024 == 0 && oneapi::tbb::is_current_task_group_canceling()) throw Cancelled();
        merges_.push_back({a, b});
        patches_.push_back(merged(patches_[a], patches_[b]));
        inversions_ += pair.distance < std::max(heights_[a], heights_[b]) ? 1 : 0;
        heights_.push_back(pair.distance);
        search_->remove(b);
        search_->replace(a, made, patches_[made]);
        const std::size_t left = count_ - merges_.size();
        if (left < 2) return;
        if (static_cast<double>(left) < rebuild_at * static_cast<double>(built_)) rebuild();
        queue_.push(candidate(made));
    }
    void rebuild() {
        std::vector<std::uint32_t> numbers;
        for (std::uint32_t i = 0; i < patches_.size(); ++i)
            if (!search_ || search_->contains(i)) numbers.push_back(i);
        built_ = numbers.size();
        search_.emplace(metric_, patches_, numbers, 2 * count_);
    }

    static constexpr double rebuild_at = 0.65;  // of the patches that the search was built of: boxes grow with every merge

    PatchMetric metric_;
    std::size_t count_, built_ = 0;
    std::vector<Patch> patches_;
    std::vector<float> heights_;  // distance of the merge that made each
    std::vector<Merge> merges_;
    std::optional<PatchSearch> search_;
    std::priority_queue<Candidate> queue_;
    std::uint64_t inversions_ = 0;
};

}  // namespace

ClusteredSurfels cluster_surfels(const Agglomerative& technique, const Surfels& surfels) {
    Merging merging(technique, surfels);
    merging.run();
    ClusteredSurfels made = in_post_order(surfels, merging.merges());
    made.tree.inversions = merging.inversions();
    return made;
}

}  // namespace interreflect
