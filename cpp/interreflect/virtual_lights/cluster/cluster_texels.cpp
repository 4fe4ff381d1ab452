#include "virtual_lights/cluster/cluster_texels.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>

#include "math/parallel.h"
#include "virtual_lights/sample/texel_lights.h"

namespace interreflect {
namespace {

constexpr int band_rows = 8;

/// Rows [y0, y1) of a map.
struct Band {
    std::size_t map;
    int y0, y1;
};
std::vector<Band> bands_of(const LightMaps& maps) {
    std::vector<Band> bands;
    for (std::size_t m = 0; m < maps.maps.size(); ++m)
        for (int y = 0; y < maps.maps[m].size; y += band_rows)
            bands.push_back({m, y, std::min(y + band_rows, maps.maps[m].size)});
    return bands;
}

/// Texels in pieces that do not depend on the number of threads: body(piece, map, begin, end) with texels of one map.
constexpr std::size_t sum_pieces = 16;
template <class Body>
void for_pieces(const LightMaps& maps, const Body& body) {
    const auto first = first_texels(maps);
    const std::size_t each = (first.back() + sum_pieces - 1) / sum_pieces;
    parallel_pieces(sum_pieces, [&](std::size_t piece) {
        const std::size_t from = piece * each, to = std::min(from + each, first.back());
        for (std::size_t m = 0; m < maps.maps.size(); ++m) {
            const std::size_t begin = std::max(from, first[m]), end = std::min(to, first[m + 1]);
            if (begin < end) body(piece, m, begin - first[m], end - first[m], first[m]);
        }
    });
}

}  // namespace

TexelMetric::TexelMetric(const KMeans& technique, const LightMaps& maps) {
    const double sum = technique.position_weight + technique.normal_weight + technique.flux_weight;
    if (!(sum > 0)) throw std::invalid_argument("KMeans: at least one of its weights must be above 0");
    std::vector<std::vector<LitExtent>> parts(sum_pieces, std::vector<LitExtent>(maps.maps.size()));
    for_pieces(maps, [&](std::size_t piece, std::size_t m, std::size_t begin, std::size_t end, std::size_t) {
        parts[piece][m] = lit_extent(maps.maps[m], begin, end);
    });
    Bounds bounds;
    scale_.assign(maps.maps.size(), 0.0f);
    for (std::size_t m = 0; m < maps.maps.size(); ++m) {
        float largest = 0;
        for (const auto& part : parts) bounds.add(part[m].bounds), largest = std::max(largest, part[m].largest);
        if (largest > 0) scale_[m] = 1.0f / largest;
    }
    const float extent = glm::length(bounds.upper - bounds.lower);
    const bool extended = extent > 0 && std::isfinite(extent);
    weights_.position = extended ? static_cast<float>(technique.position_weight / sum) / extent : 0.0f;
    weights_.normal = static_cast<float>(technique.normal_weight / sum);
    weights_.flux = static_cast<float>(technique.flux_weight / sum);
}

ClusterCentre centre_at(const LightMaps& maps, const TexelMetric& metric, std::size_t map, std::size_t texel) {
    const ReflectiveShadowMap& from = maps.maps[map];
    return {from.position[texel],
            from.normal[texel],
            from.flux[texel] * metric.flux_scale(map),
            static_cast<int>(map),
            static_cast<int>(texel % from.size),
            static_cast<int>(texel / from.size),
            sends(from, texel)};
}

namespace {

/// Texels of several rows that are compared together.
constexpr int block_columns = 32;
struct Block {
    int x0, x1;
};

/// The centres that may win texels of a band, of a block of it, and of anywhere; always in their own order.
class Candidates {
  public:
    Candidates(const KMeans& technique, bool splats, std::span<const ClusterCentre> centres)
        : before_(technique.splat_size / 2), after_((technique.splat_size - 1) / 2), splats_(splats) {
        for (std::uint32_t c = 0; c < centres.size(); ++c)
            if (centres[c].valid) all_.push_back(made(c, centres[c]));
    }
    bool splats() const { return splats_; }
    /// Every centre, with no splat's border.
    std::vector<MetricCentre> anywhere() const {
        std::vector<MetricCentre> found = all_;
        for (MetricCentre& one : found)
            one.first_x = -far, one.last_x = far, one.first_row = -everywhere, one.last_row = everywhere;
        return found;
    }
    void of_band(const Band& band, std::vector<MetricCentre>& found) const {
        found.clear();
        for (const MetricCentre& one : all_)
            if (one.first_row < band.y1 && one.last_row >= band.y0) found.push_back(one);
    }
    /// Columns count from x0 on.
    static void of_block(std::span<const MetricCentre> of_band, const Block& block, std::vector<MetricCentre>& found) {
        found.clear();
        const auto x0 = static_cast<float>(block.x0), x1 = static_cast<float>(block.x1);
        for (const MetricCentre& one : of_band) {
            if (one.first_x >= x1 || one.last_x < x0) continue;
            found.push_back(one);
            found.back().first_x -= x0, found.back().last_x -= x0;
        }
    }

  private:
    static constexpr int everywhere = 1 << 24;
    static constexpr auto far = static_cast<float>(everywhere);

    MetricCentre made(std::uint32_t c, const ClusterCentre& centre) const {
        MetricCentre one{centre.position, centre.normal, centre.flux, -far, far, -everywhere, everywhere, c};
        if (!splats_) return one;
        one.first_x = static_cast<float>(centre.x - before_), one.last_x = static_cast<float>(centre.x + after_);
        one.first_row = centre.y - before_, one.last_row = centre.y + after_;
        return one;
    }
    int before_, after_;
    bool splats_;
    std::vector<MetricCentre> all_;
};

/// Texels that no splat covers, side by side.
struct Strays {
    std::vector<vec3> position, normal, flux;
    std::vector<std::uint32_t*> cluster;

    void add(const ReflectiveShadowMap& map, std::size_t texel, std::uint32_t* to) {
        position.push_back(map.position[texel]), normal.push_back(map.normal[texel]), flux.push_back(map.flux[texel]);
        cluster.push_back(to);
    }
    void assign(float flux_scale, const MetricWeights& weights, std::span<const MetricCentre> centres) const {
        std::vector<std::uint32_t> nearest(cluster.size());
        const TexelRow row{position.data(), normal.data(), flux.data(), static_cast<int>(cluster.size()), 0, flux_scale};
        nearest_centres(row, weights, centres, nearest.data());
        for (std::size_t i = 0; i < cluster.size(); ++i) *cluster[i] = nearest[i];
    }
};

}  // namespace

std::uint64_t assign_texels(const KMeans& technique, const LightMaps& maps, const TexelMetric& metric,
                            std::span<const ClusterCentre> centres, Buffer<std::uint32_t>& cluster) {
    const auto bands = bands_of(maps);
    const auto first = first_texels(maps);
    const Candidates candidates(technique, maps.maps.size() == 1, centres);
    std::atomic<std::uint64_t> strays = 0;
    parallel_pieces(bands.size(), [&](std::size_t piece) {
        const Band& band = bands[piece];
        const ReflectiveShadowMap& map = maps.maps[band.map];
        const float flux_scale = metric.flux_scale(band.map);
        std::uint32_t* const nearest = cluster.data() + first[band.map];
        const int columns = candidates.splats() ? block_columns : map.size;
        std::vector<MetricCentre> of_band, of_block;
        candidates.of_band(band, of_band);
        Strays lost;
        for (int x0 = 0; x0 < map.size; x0 += columns) {
            const Block block{x0, std::min(x0 + columns, map.size)};
            Candidates::of_block(of_band, block, of_block);
            for (int y = band.y0; y < band.y1; ++y) {
                const std::size_t at = static_cast<std::size_t>(y) * map.size + x0;
                const TexelRow row{
                    map.position.data() + at, map.normal.data() + at, map.flux.data() + at, block.x1 - x0, y, flux_scale};
                if (!nearest_centres(row, metric.weights(), of_block, nearest + at)) continue;
                for (std::size_t i = at; i < at + static_cast<std::size_t>(row.count); ++i)
                    if (nearest[i] == no_virtual_light && sends(map, i)) lost.add(map, i, nearest + i);
            }
        }
        if (lost.cluster.empty()) return;
        lost.assign(flux_scale, metric.weights(), candidates.anywhere());
        strays += lost.cluster.size();
    });
    return strays;
}

ClusterSums sum_texels(const LightMaps& maps, const Buffer<std::uint32_t>& cluster, std::vector<vec3> origins) {
    const std::size_t clusters = origins.size();
    std::vector<std::vector<ClusterSum>> parts(sum_pieces, std::vector<ClusterSum>(clusters));
    for_pieces(maps, [&](std::size_t piece, std::size_t m, std::size_t begin, std::size_t end, std::size_t first) {
        add_texels({maps.maps[m], cluster.data(), first, begin, end}, origins, parts[piece]);
    });
    ClusterSums all{std::move(origins), std::vector<ClusterSum>(clusters)};
    for (const auto& part : parts)
        for (std::size_t c = 0; c < clusters; ++c) all.sums[c] += part[c];
    return all;
}

std::vector<std::uint32_t> pick_members(const LightMaps& maps, const Buffer<std::uint32_t>& cluster,
                                        std::span<const TypicalPlace> places, Pick pick) {
    std::vector<std::vector<PickedTexel>> parts(sum_pieces, std::vector<PickedTexel>(places.size()));
    for_pieces(maps, [&](std::size_t piece, std::size_t m, std::size_t begin, std::size_t end, std::size_t first) {
        pick_texels({maps.maps[m], cluster.data(), first, begin, end}, places, pick == Pick::furthest, parts[piece]);
    });
    std::vector<std::uint32_t> picked(places.size(), no_virtual_light);
    for (std::size_t c = 0; c < places.size(); ++c) {
        float least = std::numeric_limits<float>::infinity();
        for (const auto& part : parts)
            if (part[c].distance < least) least = part[c].distance, picked[c] = part[c].texel;
    }
    return picked;
}

}  // namespace interreflect
