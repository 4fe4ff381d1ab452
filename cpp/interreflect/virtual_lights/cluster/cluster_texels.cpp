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
    Bounds bounds;
    for (const auto& map : maps.maps) {
        float largest = 0;
        for (std::size_t i = 0; i < map.texels(); ++i)
            if (sends(map, i)) bounds.add(map.position[i]), largest = std::max(largest, max_component(map.flux[i]));
        scale_.push_back(largest > 0 ? 1.0f / largest : 0.0f);
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

/// The centres that may win texels of rows, and those that may win any.
class Candidates {
  public:
    Candidates(const KMeans& technique, bool splats, std::span<const ClusterCentre> centres)
        : before_(technique.splat_size / 2), after_((technique.splat_size - 1) / 2), splats_(splats), centres_(centres) {
        for (std::uint32_t c = 0; c < centres.size(); ++c)
            if (centres[c].valid) all_.push_back(made(c, everywhere));
    }
    const std::vector<MetricCentre>& all() const { return all_; }
    const std::vector<MetricCentre>& of_row(int y, std::vector<MetricCentre>& memory) const {
        if (!splats_) return all_;
        memory.clear();
        for (const MetricCentre& one : all_)
            if (const int at = centres_[one.cluster].y; at - before_ <= y && y <= at + after_)
                memory.push_back(made(one.cluster, after_));
        return memory;
    }

  private:
    static constexpr int everywhere = 1 << 24;

    MetricCentre made(std::uint32_t c, int reach) const {
        const ClusterCentre& centre = centres_[c];
        const int back = reach == everywhere ? everywhere : before_;
        return {centre.position,
                centre.normal,
                centre.flux,
                static_cast<float>(centre.x - back),
                static_cast<float>(centre.x + reach),
                c};
    }
    int before_, after_;
    bool splats_;
    std::span<const ClusterCentre> centres_;
    std::vector<MetricCentre> all_;
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
        std::vector<MetricCentre> memory;
        std::uint64_t lost = 0;
        for (int y = band.y0; y < band.y1; ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * map.size;
            std::uint32_t* nearest = cluster.data() + first[band.map] + row;
            const auto texels = [&](int x, int count) {
                return TexelRow{map.position.data() + row + x, map.normal.data() + row + x, map.flux.data() + row + x, count,
                                metric.flux_scale(band.map)};
            };
            nearest_centres(texels(0, map.size), metric.weights(), candidates.of_row(y, memory), nearest);
            for (int x = 0; x < map.size; ++x) {
                if (!sends(map, row + x)) {
                    nearest[x] = no_virtual_light;
                } else if (nearest[x] == no_virtual_light) {
                    nearest_centres(texels(x, 1), metric.weights(), candidates.all(), nearest + x);
                    ++lost;
                }
            }
        }
        strays += lost;
    });
    return strays;
}

ClusterSums sum_texels(const LightMaps& maps, const Buffer<std::uint32_t>& cluster, std::size_t clusters) {
    std::vector<ClusterSums> parts(sum_pieces, ClusterSums(clusters));
    for_pieces(maps, [&](std::size_t piece, std::size_t m, std::size_t begin, std::size_t end, std::size_t first) {
        const ReflectiveShadowMap& map = maps.maps[m];
        ClusterSums& sums = parts[piece];
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t c = cluster[first + i];
            if (c == no_virtual_light) continue;
            const glm::dvec3 position(map.position[i]);
            const double weight = luminance(map.flux[i]);
            sums.position[c] += position * weight;
            sums.normal[c] += glm::dvec3(map.normal[i]) * weight;
            sums.square[c] += glm::dot(position, position) * weight;
            sums.weight[c] += weight;
            sums.flux[c] += glm::dvec3(map.flux[i]);
            sums.area[c] += map.area[i];
            ++sums.members[c];
        }
    });
    ClusterSums all(clusters);
    for (const ClusterSums& part : parts)
        for (std::size_t c = 0; c < clusters; ++c) {
            all.position[c] += part.position[c], all.normal[c] += part.normal[c], all.flux[c] += part.flux[c];
            all.area[c] += part.area[c], all.members[c] += part.members[c];
            all.weight[c] += part.weight[c], all.square[c] += part.square[c];
        }
    return all;
}

std::vector<std::uint32_t> pick_members(const LightMaps& maps, const Buffer<std::uint32_t>& cluster, std::span<const vec3> places,
                                        Pick pick) {
    struct Best {
        float distance;
        std::uint32_t texel = no_virtual_light;
    };
    const float sign = pick == Pick::nearest ? 1.0f : -1.0f;
    std::vector<std::vector<Best>> parts(sum_pieces,
                                         std::vector<Best>(places.size(), Best{std::numeric_limits<float>::infinity()}));
    for_pieces(maps, [&](std::size_t piece, std::size_t m, std::size_t begin, std::size_t end, std::size_t first) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t c = cluster[first + i];
            if (c == no_virtual_light) continue;
            const vec3 to = maps.maps[m].position[i] - places[c];
            const float distance = sign * glm::dot(to, to);
            Best& best = parts[piece][c];
            if (distance < best.distance) best = {distance, static_cast<std::uint32_t>(first + i)};
        }
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
