/// Sums and extremes over neighbouring texels of reflective shadow maps, of every cluster among them.
#pragma once
#include <cstdint>
#include <span>

#include "data/geometry.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

/// Of a cluster's texels; a texel's weight is the luminance of its flux. Places are relative to an origin of the cluster's own.
struct ClusterSum {
    glm::dvec3 position{0}, normal{0}, flux{0};  // the first two weighted
    double weight = 0, square = 0, area = 0;     // square: weighted, of the distance from the origin
    std::uint32_t members = 0;

    ClusterSum& operator+=(const ClusterSum& other) {
        position += other.position, normal += other.normal, flux += other.flux;
        weight += other.weight, square += other.square, area += other.area, members += other.members;
        return *this;
    }
};
/// Texels [begin, end) of a map, whose first one has number `first` of all; `cluster`: of all texels.
struct TexelRange {
    const ReflectiveShadowMap& map;
    const std::uint32_t* cluster;
    std::size_t first, begin, end;
};
void add_texels(const TexelRange& texels, std::span<const vec3> origins, std::span<ClusterSum> sums);

/// What a cluster's texels are compared with. Their distance is sqrt(|x - x'|^2 + spread^2 |n - n'|^2): a normal that points away
/// counts as a place about as far off as the cluster is wide.
struct TypicalPlace {
    vec3 position{0}, normal{0};
    float spread2 = 0;  // mean square distance of the texels from their mean
};
/// The texel of a cluster nearest to its place, the first of several; `furthest`: with the distance squared made negative.
struct PickedTexel {
    float distance = std::numeric_limits<float>::infinity();  // squared
    std::uint32_t texel = ~0U;                                // number of all
};
void pick_texels(const TexelRange& texels, std::span<const TypicalPlace> places, bool furthest, std::span<PickedTexel> picked);

/// What texels that send light on span, and the largest component of their flux.
struct LitExtent {
    Bounds bounds;
    float largest = 0;
};
LitExtent lit_extent(const ReflectiveShadowMap& map, std::size_t begin, std::size_t end);

}  // namespace interreflect
