/// The two steps of a k-means iteration over texels of reflective shadow maps.
#pragma once
#include <span>
#include <vector>

#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"
#include "virtual_lights/cluster/kmeans.h"
#include "virtual_lights/cluster/nearest_centre.h"
#include "virtual_lights/cluster/texel_runs.h"

namespace interreflect {

/// A cluster's centre, with what the metric compares.
struct ClusterCentre {
    vec3 position{0}, normal{0}, flux{0};  // flux over the largest of its map
    int map = 0;
    int x = 0, y = 0;   // texel of the map
    bool valid = true;  // sends light on
};

/// By what texels and centres are compared.
class TexelMetric {
  public:
    /// std::invalid_argument where all weights are 0.
    TexelMetric(const KMeans& technique, const LightMaps& maps);
    const MetricWeights& weights() const { return weights_; }
    /// 1 / the largest flux of a map.
    float flux_scale(std::size_t map) const { return scale_[map]; }

  private:
    MetricWeights weights_;
    std::vector<float> scale_;
};

ClusterCentre centre_at(const LightMaps& maps, const TexelMetric& metric, std::size_t map, std::size_t texel);

/// Writes every texel's cluster, or no_virtual_light where it sends nothing on; returns how many no splat covered.
std::uint64_t assign_texels(const KMeans& technique, const LightMaps& maps, const TexelMetric& metric,
                            std::span<const ClusterCentre> centres, Buffer<std::uint32_t>& cluster);

/// Over the texels of each cluster.
struct ClusterSums {
    std::vector<vec3> origin;  // of the places that are summed
    std::vector<ClusterSum> sums;

    std::uint32_t members(std::size_t c) const { return sums[c].members; }
    vec3 mean(std::size_t c) const { return origin[c] + vec3(sums[c].position / sums[c].weight); }
    /// Mean square distance from the mean.
    double spread2(std::size_t c) const {
        const glm::dvec3 middle = sums[c].position / sums[c].weight;
        return std::fmax(sums[c].square / sums[c].weight - glm::dot(middle, middle), 0.0);
    }
    /// Of the disk with the same spread about its middle: a disk of radius R has a mean square distance of R^2 / 2.
    double spread_area(std::size_t c) const { return 2.0 * std::numbers::pi * spread2(c); }
    TypicalPlace typical(std::size_t c) const {
        const auto length = static_cast<float>(glm::length(sums[c].normal));
        return {mean(c), length > 0 ? vec3(sums[c].normal) / length : vec3(0), static_cast<float>(spread2(c))};
    }
};
/// `origins`: of each cluster, near its texels.
ClusterSums sum_texels(const LightMaps& maps, const Buffer<std::uint32_t>& cluster, std::vector<vec3> origins);

/// The member next to a place of each cluster, or furthest from it: numbers of texels over all maps; no_virtual_light without
/// members.
enum class Pick { nearest, furthest };
std::vector<std::uint32_t> pick_members(const LightMaps& maps, const Buffer<std::uint32_t>& cluster,
                                        std::span<const TypicalPlace> places, Pick pick);

}  // namespace interreflect
