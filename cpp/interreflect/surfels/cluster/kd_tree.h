#pragma once
#include "data/technique.h"
#include "surfels/cluster/post_order.h"

namespace interreflect {

/// Surfels are halved at the median of the axis along which they spread most; normals count as three more.
struct KdTree {
    double normal_weight = 0.1;

    bool operator==(const KdTree&) const = default;
    static constexpr auto description =
        describe("KdTree", "Surfels halved at the median of the axis along which they spread most.",
                 Source{"Jendersie et al. 2016", "4.3, the quick one"},
                 Param{"normal_weight", &KdTree::normal_weight,
                       "of 1 - cosine between normals, beside squared distances over the extent's square; 0: places alone",
                       Unit::none, between(0, 1000)});
};

ClusteredSurfels cluster_surfels(const KdTree& technique, const Surfels& surfels);

}  // namespace interreflect
