#include "surfels/cluster/patch_search.h"

#include <algorithm>
#include <bit>

namespace interreflect {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

float outside(float x, float lower, float upper) { return std::max(std::max(lower - x, x - upper), 0.0f); }

}  // namespace

PatchSearch::PatchSearch(const PatchMetric& metric, std::span<const Patch> patches, std::span<const std::uint32_t> numbers,
                         std::size_t capacity)
    : metric_(metric), slot_(capacity, none) {
    const std::size_t leaves = std::bit_ceil(std::max<std::size_t>((numbers.size() + width - 1) / width, 1));
    boxes_.resize(2 * leaves), leaves_.resize(leaves);
    std::vector<Item> items;
    items.reserve(numbers.size());
    for (const std::uint32_t number : numbers) items.push_back(item_of(patches[number], number));
    build(items, 1);
}

PatchSearch::Item PatchSearch::item_of(const Patch& p, std::uint32_t number) {
    return {{p.position.x, p.position.y, p.position.z, p.normal.x, p.normal.y, p.normal.z, p.area}, number};
}

std::size_t PatchSearch::widest(std::span<const Item> items) const {
    std::size_t axis = 0;
    float most = -1;
    for (std::size_t k = 0; k < axes; ++k) {
        float lower = infinity, upper = -infinity;
        for (const Item& item : items) lower = std::min(lower, item.value[k]), upper = std::max(upper, item.value[k]);
        const float spread = upper - lower;
        // What the ends' distance is made of along this axis; |n - n'|^2 = 2 (1 - n . n').
        const float share = k < 3   ? spread * spread
                            : k < 6 ? 0.5f * metric_.normal_weight * spread * spread
                                    : metric_.balance_weight * PatchMetric::imbalance(lower, upper);
        if (share > most) most = share, axis = k;
    }
    return axis;
}

void PatchSearch::build(std::span<Item> items, std::size_t node) {
    if (node >= leaves_.size()) {
        const std::size_t leaf = node - leaves_.size();
        for (std::size_t k = 0; k < width; ++k) put(leaf * width + k, k < items.size() ? items[k] : Item{{infinity}, none});
        fit_leaf(leaf);
        return;
    }
    const std::size_t middle = items.size() / 2;
    if (items.size() > 1) {
        const std::size_t axis = widest(items);
        std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(middle), items.end(),
                         [axis](const Item& a, const Item& b) {
                             return a.value[axis] != b.value[axis] ? a.value[axis] < b.value[axis] : a.number < b.number;
                         });
    }
    build(items.first(middle), 2 * node);
    build(items.subspan(middle), 2 * node + 1);
    fit_inner(node);
}

void PatchSearch::put(std::size_t slot, const Item& item) {
    Leaf& leaf = leaves_[slot / width];
    for (std::size_t k = 0; k < axes; ++k) leaf.value[k][slot % width] = item.value[k];
    leaf.number[slot % width] = item.number;
    if (item.number != none) slot_[item.number] = static_cast<std::uint32_t>(slot);
}

void PatchSearch::fit_leaf(std::size_t l) {
    Box& box = boxes_[leaves_.size() + l];
    const Leaf& leaf = leaves_[l];
    box.lower.fill(infinity), box.upper.fill(-infinity), box.first = none, box.last = 0;
    for (std::size_t i = 0; i < width; ++i) {
        if (leaf.number[i] == none) continue;
        for (std::size_t k = 0; k < axes; ++k) {
            box.lower[k] = std::min(box.lower[k], leaf.value[k][i]);
            box.upper[k] = std::max(box.upper[k], leaf.value[k][i]);
        }
        box.first = std::min(box.first, leaf.number[i]), box.last = std::max(box.last, leaf.number[i]);
    }
}

bool PatchSearch::fit_inner(std::size_t node) {
    const Box &a = boxes_[2 * node], &b = boxes_[2 * node + 1];
    Box box;
    for (std::size_t k = 0; k < axes; ++k) {
        box.lower[k] = std::min(a.lower[k], b.lower[k]);
        box.upper[k] = std::max(a.upper[k], b.upper[k]);
    }
    box.first = std::min(a.first, b.first), box.last = std::max(a.last, b.last);
    const bool changed = !(box == boxes_[node]);
    boxes_[node] = box;
    return changed;
}

void PatchSearch::fit(std::size_t slot) {
    fit_leaf(slot / width);
    for (std::size_t node = (leaves_.size() + slot / width) / 2; node > 0 && fit_inner(node);) node /= 2;
}

void PatchSearch::remove(std::uint32_t number) {
    const std::size_t slot = slot_[number];
    slot_[number] = none;
    put(slot, {{infinity}, none});
    fit(slot);
}

void PatchSearch::replace(std::uint32_t old, std::uint32_t number, const Patch& patch) {
    const std::size_t slot = slot_[old];
    slot_[old] = none;
    put(slot, item_of(patch, number));
    fit(slot);
}

float PatchSearch::bound(const Patch& p, const Box& box) const {
    if (box.first == none) return infinity;
    const auto& low = box.lower;
    const auto& high = box.upper;
    const float square = PatchMetric::square(outside(p.position.x, low[0], high[0]), outside(p.position.y, low[1], high[1]),
                                             outside(p.position.z, low[2], high[2]));
    const float cosine = std::max(p.normal.x * low[3], p.normal.x * high[3]) +
                         std::max(p.normal.y * low[4], p.normal.y * high[4]) +
                         std::max(p.normal.z * low[5], p.normal.z * high[5]);
    return metric_.sum(square, cosine, PatchMetric::imbalance(p.area, std::clamp(p.area, low[6], high[6])));
}

void PatchSearch::search_leaf(const Patch& p, std::uint32_t number, const Leaf& leaf, NearestPatch& best) const {
    Lanes distance;
    for (std::size_t i = 0; i < width; ++i) {
        const auto& v = leaf.value;
        const float cosine = p.normal.x * v[3][i] + p.normal.y * v[4][i] + p.normal.z * v[5][i];
        distance[i] = metric_.sum(PatchMetric::square(p.position.x - v[0][i], p.position.y - v[1][i], p.position.z - v[2][i]),
                                  cosine, PatchMetric::imbalance(p.area, v[6][i]));
    }
    for (std::size_t i = 0; i < width; ++i) {
        if (distance[i] > best.distance || leaf.number[i] == number) continue;
        if (distance[i] == best.distance) {
            const std::uint32_t here = gap(number, leaf.number[i]), before = gap(number, best.number);
            if (here > before || (here == before && leaf.number[i] >= best.number)) continue;
        }
        best = {distance[i], leaf.number[i]};
    }
}

NearestPatch PatchSearch::nearest(const Patch& patch, std::uint32_t number) const {
    struct Open {
        float bound;
        std::uint32_t gap, node;
        bool operator<(const Open& o) const { return bound != o.bound ? bound < o.bound : gap < o.gap; }
    };
    const auto open_node = [&](std::size_t node) {
        const Box& box = boxes_[node];
        return Open{bound(patch, box), gap(number, std::clamp(number, box.first, std::max(box.first, box.last))),
                    static_cast<std::uint32_t>(node)};
    };
    std::array<Open, 64> open;
    std::size_t count = 0;
    NearestPatch best;
    open[count++] = open_node(1);
    while (count > 0) {
        const Open next = open[--count];
        if (next.bound > best.distance || (next.bound == best.distance && next.gap > gap(number, best.number))) continue;
        if (next.node >= leaves_.size()) {
            search_leaf(patch, number, leaves_[next.node - leaves_.size()], best);
            continue;
        }
        Open left = open_node(2 * next.node), right = open_node(2 * next.node + 1);
        if (left < right) std::swap(left, right);
        if (left.bound <= best.distance) open[count++] = left;
        if (right.bound <= best.distance) open[count++] = right;
    }
    return best;
}

}  // namespace interreflect
