#include "caches/distribute/tile_clusters.h"

#include <algorithm>
#include <numeric>

#include "math/rng.h"

namespace interreflect {

void TileClusters::start() {
    clusters.clear();
    table_.assign(64, none);
}

std::uint32_t TileClusters::find(std::uint32_t key) {
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
    return table_[at];
}

// Neighbours mostly share their key: runs of one are found and added up at once.
void TileClusters::group(const GBuffer& gbuffer, const Tile& tile, std::span<const std::uint32_t> key) {
    start();
    slot.resize(key.size());
    std::size_t at = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
        const std::size_t row_end = at + static_cast<std::size_t>(tile.x1 - tile.x0);
        std::size_t pixel = static_cast<std::size_t>(y) * gbuffer.width + tile.x0;
        while (at < row_end) {
            const std::uint32_t shared = key[at], number = shared == none ? none : find(shared);
            vec3 lower(std::numeric_limits<float>::infinity()), upper(-lower), normal(0);
            const std::size_t begin = at;
            for (; at < row_end && key[at] == shared; ++at, ++pixel) {
                slot[at] = number;
                const vec3& position = gbuffer.position[pixel];
                lower = glm::min(lower, position), upper = glm::max(upper, position);
                normal += gbuffer.normal[pixel];
            }
            if (number == none) continue;
            Cluster& cluster = clusters[number];
            cluster.members += static_cast<std::uint32_t>(at - begin);
            cluster.lower = glm::min(cluster.lower, lower), cluster.upper = glm::max(cluster.upper, upper);
            cluster.normal += normal;
        }
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

void TileClusters::choose_pixels(const GBuffer& gbuffer, const Tile& tile) {
    if (clusters.empty()) return;
    lines_.reset(clusters.size());
    for (std::size_t i = 0; i < clusters.size(); ++i) {
        const Cluster& cluster = clusters[i];
        const float extent = glm::length(cluster.upper - cluster.lower), length = glm::length(cluster.normal);
        lines_.set(i, 0.5f * (cluster.lower + cluster.upper), length > 0.0f ? cluster.normal / length : vec3(0),
                   extent > 0.0f ? 1.0f / extent : 0.0f);
    }
    const auto columns = static_cast<std::size_t>(tile.x1 - tile.x0);
    score_.resize(columns);
    std::size_t at = 0;
    for (int y = tile.y0; y < tile.y1; ++y) {
        const std::size_t first = static_cast<std::size_t>(y) * gbuffer.width + tile.x0;
        score_pixels(gbuffer.position.data() + first, gbuffer.normal.data() + first, slot.data() + at, columns, lines_,
                     score_.data());
        for (std::size_t x = 0; x < columns; ++x, ++at) {
            if (slot[at] == none || score_[x] <= clusters[slot[at]].score) continue;
            clusters[slot[at]].score = score_[x];
            clusters[slot[at]].pixel = static_cast<std::uint32_t>(first + x);
        }
    }
}

}  // namespace interreflect
