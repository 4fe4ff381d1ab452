/// The two steps of a k-means iteration over texels of reflective shadow maps.
#pragma once
#include <span>
#include <vector>

#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"
#include "virtual_lights/cluster/kmeans.h"
#include "virtual_lights/cluster/nearest_centre.h"

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

/// Over the texels of each cluster; a texel's weight is the luminance of its flux.
struct ClusterSums {
    std::vector<glm::dvec3> position, normal, flux;  // the first two weighted
    std::vector<double> weight, square, area;        // square: weighted, of the position's distance from the origin
    std::vector<std::uint32_t> members;

    explicit ClusterSums(std::size_t n)
        : position(n, glm::dvec3(0)),
          normal(n, glm::dvec3(0)),
          flux(n, glm::dvec3(0)),
          weight(n, 0.0),
          square(n, 0.0),
          area(n, 0.0),
          members(n, 0) {}
    vec3 mean(std::size_t c) const { return vec3(position[c] / weight[c]); }
    /// Of the disk with the same spread about its middle: a disk of radius R has a mean square distance of R^2 / 2.
    double spread_area(std::size_t c) const {
        const glm::dvec3 middle = position[c] / weight[c];
        return 2.0 * std::numbers::pi * std::fmax(square[c] / weight[c] - glm::dot(middle, middle), 0.0);
    }
};
ClusterSums sum_texels(const LightMaps& maps, const Buffer<std::uint32_t>& cluster, std::size_t clusters);

/// The member next to a place of each cluster, or furthest from it: numbers of texels over all maps; no_virtual_light without
/// members.
enum class Pick { nearest, furthest };
std::vector<std::uint32_t> pick_members(const LightMaps& maps, const Buffer<std::uint32_t>& cluster, std::span<const vec3> places,
                                        Pick pick);

}  // namespace interreflect
