#include "caches/distribute/tile_clusters.h"

#include <algorithm>
#include <numeric>

#include "math/rng.h"

namespace interreflect {

void TileClusters::start() {
    clusters.clear();
    table_.assign(64, none);
    last_ = none;
}

std::uint32_t TileClusters::find(std::uint32_t key) {
    if (last_ != none && clusters[last_].key == key) return last_;
    if (2 * clusters.size() >= table_.size()) {
        table_.assign(2 * table_.size(), none);
        for (std::size_t i = 0; i < clusters.size(); ++i) {
            std::size_t at = hash32(clusters[i].key) & (table_.size() - 1);
            while (table_[at] != none) at = (at + 1) & (table_.size() - 1);
            table_[at] = static_cast<std::uint32_t>(i);
        }
    }
    std::size_t at = hash32(key) & (table_.size() - 1);
    while (table_[at] != none && clusters[table_[at]].key != key) at = (at + 1) & (table_.size() - 1);
    if (table_[at] == none) {
        table_[at] = static_cast<std::uint32_t>(clusters.size());
        clusters.emplace_back().key = key;
    }
    return last_ = table_[at];
}

// Neighbours mostly share their key: runs of one are found and added up at once.
void TileClusters::group(const TilePixels& pixels, std::span<const std::uint32_t> key) {
    start();
    slot.resize(with_room(key.size()));
    std::fill(slot.begin() + static_cast<std::ptrdiff_t>(key.size()), slot.end(), none);
    const auto vector_of = [](const Coordinates& of, std::size_t i) { return vec3(of[0][i], of[1][i], of[2][i]); };
    for (std::size_t at = 0, row_end = 0; at < key.size();) {
        if (at == row_end) row_end += pixels.rows().columns;
        const std::size_t begin = at;
        const std::uint32_t shared = key[at];
        while (at < row_end && key[at] == shared) ++at;
        const std::uint32_t number = shared == none ? none : find(shared);
        std::fill(slot.begin() + static_cast<std::ptrdiff_t>(begin), slot.begin() + static_cast<std::ptrdiff_t>(at), number);
        if (number == none) continue;
        vec3 lower(std::numeric_limits<float>::infinity()), upper(-lower), normal(0);
        for (std::size_t i = begin; i < at; ++i) {
            const vec3 position = vector_of(pixels.position, i);
            lower = glm::min(lower, position), upper = glm::max(upper, position);
            normal += vector_of(pixels.normal, i);
        }
        Cluster& cluster = clusters[number];
        if (cluster.members == 0) cluster.pixel = static_cast<std::uint32_t>(begin);
        cluster.members += static_cast<std::uint32_t>(at - begin);
        cluster.lower = glm::min(cluster.lower, lower), cluster.upper = glm::max(cluster.upper, upper);
        cluster.normal += normal;
    }
    sort();
}

std::size_t TileClusters::count(std::span<const std::uint32_t> key) {
    start();
    std::uint32_t last = none;
    for (const std::uint32_t one : key) {
        if (one == last) continue;
        if (one != none) find(one);
        last = one;
    }
    return clusters.size();
}

void TileClusters::sort() {
    if (std::is_sorted(clusters.begin(), clusters.end(), [](const auto& a, const auto& b) { return a.key < b.key; })) return;
    std::vector<std::uint32_t> order(clusters.size()), place(clusters.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return clusters[a].key < clusters[b].key; });
    std::vector<Cluster> sorted;
    sorted.reserve(clusters.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        place[order[i]] = static_cast<std::uint32_t>(i);
        sorted.push_back(clusters[order[i]]);
    }
    clusters.swap(sorted);
    for (auto& one : slot)
        if (one != none) one = place[one];
}

void TileClusters::choose_pixels(const TilePixels& pixels) {
    lines_.reset(clusters.size());
    best_.clear();
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        const Cluster& cluster = clusters[i];
        const float extent = glm::length(cluster.upper - cluster.lower), length = glm::length(cluster.normal);
        lines_.set(i, 0.5f * (cluster.lower + cluster.upper), length > 0.0f ? cluster.normal / length : vec3(0),
                   extent > 0.0f ? 1.0f / extent : 0.0f);
        best_.push_back({-std::numeric_limits<float>::infinity(), cluster.pixel});
    }
    best_pixels(pixels.position, pixels.normal, slot.data(), pixels.count(), lines_, best_.data());
    for (std::size_t i = 0; i < clusters.size(); ++i) clusters[i].pixel = best_[i].pixel;
}

}  // namespace interreflect
