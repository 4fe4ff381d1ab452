#include "caches/distribute/tile_clusters.h"

#include <algorithm>
#include <numeric>

#include "math/rng.h"

namespace interreflect {

void TileClusters::start(const Tile& tile) {
    clusters.clear();
    slot.resize(static_cast<std::size_t>(tile.x1 - tile.x0) * (tile.y1 - tile.y0));
    table_.assign(64, none);
    last_slot_ = none;
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

std::uint32_t TileClusters::add(std::uint32_t key, const vec3& position, const vec3& normal) {
    if (last_slot_ == none || key != last_key_) last_slot_ = find(key), last_key_ = key;
    Cluster& cluster = clusters[last_slot_];
    ++cluster.members;
    cluster.lower = glm::min(cluster.lower, position), cluster.upper = glm::max(cluster.upper, position);
    cluster.normal += normal;
    return last_slot_;
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
    struct Line {
        vec3 centre, normal;
        float inverse_extent;
    };
    std::vector<Line> lines;
    lines.reserve(clusters.size());
    for (const auto& cluster : clusters) {
        const float extent = glm::length(cluster.upper - cluster.lower), length = glm::length(cluster.normal);
        lines.push_back({0.5f * (cluster.lower + cluster.upper), length > 0.0f ? cluster.normal / length : vec3(0),
                         extent > 0.0f ? 1.0f / extent : 0.0f});
    }
    std::size_t at = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x, ++at) {
            if (slot[at] == none) continue;
            const auto pixel = static_cast<std::uint32_t>(y * gbuffer.width + x);
            const Line& line = lines[slot[at]];
            const vec3 away = (gbuffer.position[pixel] - line.centre) * line.inverse_extent;
            const float out = glm::dot(away, line.normal), aside = glm::length(away - line.normal * out);
            const float score = (glm::dot(gbuffer.normal[pixel], line.normal) + out) / (1.0f + aside);
            Cluster& cluster = clusters[slot[at]];
            if (score > cluster.score) cluster.score = score, cluster.pixel = pixel;
        }
}

}  // namespace interreflect
