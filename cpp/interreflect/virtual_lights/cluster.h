/// Cluster: which texels of the reflective shadow maps does one virtual light stand for?
///
///   VirtualLights cluster_lights(const Technique&, const VirtualLights& seeds, const LightMaps&, const VirtualLights* last,
///                                std::uint32_t seed);
///
/// `seeds`: what sample_lights chose; as many lights come back. `last`: what the same technique returned for the frame before
/// (null: there is none). std::invalid_argument where the seeds are of other maps. Exact counterpart: EveryRsmPixel, which
/// clusters nothing and does not look at the seeds.
#pragma once
#include <variant>

#include "virtual_lights/cluster/kmeans.h"
#include "virtual_lights/sample/every_rsm_pixel.h"

namespace interreflect {
using ClusterLights = std::variant<EveryRsmPixel, KMeans>;

inline VirtualLights cluster_lights(const EveryRsmPixel& technique, const VirtualLights&, const LightMaps& maps,
                                    const VirtualLights*, std::uint32_t seed) {
    return sample_lights(technique, maps, seed);
}

}  // namespace interreflect
