#include "surfels/link/flux_links.h"

#include <algorithm>
#include <array>
#include <bit>
#include <stdexcept>
#include <string>
#include <vector>

#include "math/parallel.h"
#include "surfels/light_caches.h"
#include "surfels/link/linked_caches.h"
#include "surfels/link/runtime_projection.h"

namespace interreflect {
namespace {

constexpr std::size_t caches_a_block = 64;

/// A node whose chosen descendants are [begin, end) of a cut, and its place among a cache's candidates.
struct Open {
    float solid_angle;
    std::uint32_t node;
    std::size_t begin, end, slot;
};

/// The tree over one cache's cut, without nodes that have one child. The widest node comes first, children side by side.
class CutTree {
  public:
    CutTree(const SurfelTree& tree, const CacheCut& cache) : tree_(tree), cache_(cache) {
        nodes_.clear(), child_.clear();
        if (cache.nodes.empty()) return;
        append(static_cast<std::uint32_t>(tree.nodes() - 1), 0, cache.nodes.size());
        const auto narrower = [](const Open& a, const Open& b) {
            return a.solid_angle != b.solid_angle ? a.solid_angle < b.solid_angle : a.slot > b.slot;
        };
        while (!open_.empty()) {
            std::ranges::pop_heap(open_, narrower);
            const Open parent = open_.back();
            open_.pop_back();
            child_[parent.slot] = static_cast<std::uint16_t>(nodes_.size());
            const std::size_t middle = split(parent.node, parent.begin, parent.end);
            for (const auto& [node, begin, end] :
                 {Part{tree_.left(parent.node), parent.begin, middle}, Part{tree_.right(parent.node), middle, parent.end}})
                if (append(node, begin, end)) std::ranges::push_heap(open_, narrower);
        }
    }
    const std::vector<std::uint32_t>& nodes() const { return nodes_; }
    const std::vector<std::uint16_t>& children() const { return child_; }

  private:
    struct Part {
        std::uint32_t node;
        std::size_t begin, end;
    };
    /// First of [begin, end) that lies in the right subtree: in post-order the left one's come before.
    std::size_t split(std::uint32_t node, std::size_t begin, std::size_t end) const {
        const auto part = cache_.nodes.subspan(begin, end - begin);
        return begin + static_cast<std::size_t>(std::ranges::upper_bound(part, tree_.left(node)) - part.begin());
    }
    /// Goes down to where the node's part of the cut parts. Whether it does.
    bool append(std::uint32_t node, std::size_t begin, std::size_t end) {
        while (end - begin > 1) {
            const std::size_t middle = split(node, begin, end);
            if (middle > begin && middle < end) break;
            node = middle == end ? tree_.left(node) : tree_.right(node);
        }
        if (end - begin == 1) node = cache_.nodes[begin];
        if (end - begin > 1) open_.push_back({cache_.cut.solid_angle(node), node, begin, end, nodes_.size()});
        nodes_.push_back(node), child_.push_back(0);
        return end - begin > 1;
    }

    const SurfelTree& tree_;
    const CacheCut& cache_;
    std::vector<std::uint32_t> nodes_;
    std::vector<std::uint16_t> child_;
    std::vector<Open> open_;
};

/// Nodes that wait to be replaced by their children, the brightest first to within an eighth of an octave: a list for each of 128
/// steps below the first node's brightness.
class Brightest {
  public:
    explicit Brightest(std::size_t slots) : next_(slots) {}

    void begin(float most) {
        top_ = step_of(most), size_ = 0;
        filled_[0] = filled_[1] = 0;
    }
    void push(float brightness, std::uint16_t slot) {
        const auto list = static_cast<std::size_t>(std::clamp(top_ - step_of(brightness), 0, 127));
        std::uint64_t& filled = filled_[list / 64];
        const std::uint64_t bit = std::uint64_t{1} << (list % 64);
        next_[slot] = (filled & bit) != 0 ? first_[list] : none;
        first_[list] = slot, filled |= bit;
        ++size_;
    }
    std::uint16_t pop() {
        const std::size_t half = filled_[0] != 0 ? 0 : 1;
        const auto list = 64 * half + static_cast<std::size_t>(std::countr_zero(filled_[half]));
        const std::uint16_t slot = first_[list];
        first_[list] = next_[slot];
        if (first_[list] == none) filled_[half] &= filled_[half] - 1;
        --size_;
        return slot;
    }
    std::size_t size() const { return size_; }

  private:
    static constexpr std::uint16_t none = 0xffff;
    /// Exponent and three bits of the mantissa.
    static int step_of(float value) { return static_cast<int>(std::bit_cast<std::uint32_t>(value) >> 20U); }

    std::vector<std::uint16_t> next_;
    std::array<std::uint16_t, 128> first_{};
    std::uint64_t filled_[2] = {};
    int top_ = 0;
    std::size_t size_ = 0;
};

/// As from_half, of normal numbers alone: cones are never narrower than the smallest.
float from_normal_half(std::uint16_t bits) { return std::bit_cast<float>((std::uint32_t{bits} << 13U) + (112U << 23U)); }

/// One cache's choice; kept from one cache to the next, for its memory.
class FluxCut {
  public:
    FluxCut(const LinkCandidates& candidates, const Buffer<float>& brightest)
        : all_(candidates), brightest_(brightest), open_(static_cast<std::size_t>(candidates.nodes.per_cache)) {}

    /// Writes at most `most` links; returns how many.
    std::size_t choose(std::size_t cache, std::size_t most, ConeLink* links) {
        const std::size_t each = static_cast<std::size_t>(all_.nodes.per_cache);
        const ConeLink* cones = all_.nodes.cones.data() + cache * each;
        if (each == 0 || cones->factor == 0) return 0;
        const std::uint16_t* child = all_.child.data() + cache * each;
        const auto brings = [&](std::size_t slot) {
            return brightest_[cones[slot].node] * from_normal_half(cones[slot].one_less_cos);
        };
        ConeLink* next = links;
        const auto take = [&](std::size_t slot) {
            const float most_brought = brings(slot);
            if (!(most_brought > 0.0f)) return;
            if (child[slot] == 0)
                *next++ = cones[slot];
            else
                open_.push(most_brought, static_cast<std::uint16_t>(slot));
        };
        open_.begin(brings(0));
        take(0);
        while (open_.size() > 0 && static_cast<std::size_t>(next - links) + open_.size() < most) {
            const std::size_t first = child[open_.pop()];
            take(first), take(first + 1);
        }
        while (open_.size() > 0) *next++ = cones[open_.pop()];
        return static_cast<std::size_t>(next - links);
    }

  private:
    const LinkCandidates& all_;
    const Buffer<float>& brightest_;
    Brightest open_;
};

/// Of every node, luma (equation 7) of the brightest radiosity of its surfels.
Buffer<float> brightest_surfels(const SurfelTree& tree, const NodeLight& light) {
    Buffer<float> brightest(tree.nodes());
    for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
        const vec3 sent = light.at(i);
        brightest[i] = tree.leaves[i] > 1
                           ? std::max(brightest[tree.left(i)], brightest[tree.right(i)])
                           : (0.25f * sent.x + 0.5f * sent.y + 0.25f * sent.z) / (light.radiosity ? 1.0f : tree.area[i]);
    }
    return brightest;
}

}  // namespace

LinkCandidates link(const FluxLinks& technique, const CacheSites& sites, const ClusteredSurfels& surfels, const Scene& scene,
                    const Intersector& intersector) {
    LinkKnobs leaves = technique, all = technique;
    leaves.links = technique.candidates, all.links = 2 * technique.candidates - 1;
    leaves.bands = all.bands = most_bands;  // candidates are the same whatever the bands
    LinkCandidates made{make_links(all, CacheLinks::Kind::cones, sites, surfels), {}};
    const auto each = static_cast<std::size_t>(made.nodes.per_cache);
    made.child = Buffer<std::uint16_t>(made.nodes.caches * each, std::uint16_t{0});
    made.nodes.counts = for_each_cut(leaves, sites, surfels, scene, intersector, [&](const CacheCut& cache) {
        const CutTree tree(surfels.tree, cache);
        cut_to_cones({cache.cache, tree.nodes(), cache.seen, cache.cut}, surfels, made.nodes);
        std::ranges::copy(tree.children(), made.child.data() + cache.cache * each);
    });
    return made;
}

CacheLinks choose_links(const FluxLinks& technique, const LinkCandidates& candidates, const SurfelTree& tree,
                        const NodeLight& light, std::span<const std::uint8_t> used) {
    check_links(candidates.nodes, light);
    if (tree.nodes() != light.size()) throw std::invalid_argument("choose_links: light of another tree");
    const std::size_t caches = candidates.nodes.caches;
    if (!used.empty() && used.size() != caches)
        throw std::invalid_argument("choose_links: `used` tells of " + std::to_string(used.size()) +
                                    " caches, the links are of " + std::to_string(caches));
    CacheLinks made;
    made.kind = CacheLinks::Kind::cones, made.bands = technique.bands, made.radiosity = candidates.nodes.radiosity;
    made.unit = candidates.nodes.unit, made.caches = caches, made.nodes = candidates.nodes.nodes;
    made.per_cache = candidates.nodes.per_cache > 0 ? technique.links : 0;
    const auto each = static_cast<std::size_t>(made.per_cache);
    made.cones = Buffer<ConeLink>(caches * each);
    const Buffer<float> brightest = brightest_surfels(tree, light);
    std::vector<std::uint64_t> chosen((caches + caches_a_block - 1) / caches_a_block);
    parallel_blocks(caches, caches_a_block, [&](std::size_t begin, std::size_t end) {
        FluxCut cut(candidates, brightest);
        for (std::size_t cache = begin; cache < end; ++cache) {
            ConeLink* links = made.cones.data() + cache * each;
            const std::size_t count = used.empty() || used[cache] != 0 ? cut.choose(cache, each, links) : 0;
            std::fill(links + count, links + each, ConeLink{0, 0, 0, 0, 0});
            chosen[begin / caches_a_block] += count;
        }
    });
    for (const std::uint64_t links : chosen) made.counts.links += links;
    return made;
}

}  // namespace interreflect
