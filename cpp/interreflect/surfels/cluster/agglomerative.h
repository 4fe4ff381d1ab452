#pragma once
#include "data/technique.h"
#include "surfels/cluster/post_order.h"

namespace interreflect {

/// The two nearest of all patches become one, over and over: Mullner's generic algorithm [arXiv 1109.2378, 3.1], with a search in
/// a hierarchy of boxes instead of a table of distances.
struct Agglomerative {
    double normal_weight = 0.1;
    double balance_weight = 0.02;

    bool operator==(const Agglomerative&) const = default;
    static constexpr auto description = describe(
        "Agglomerative", "The two nearest of all patches become one, over and over.", Source{"Jendersie et al. 2016", "4.3"},
        Param{"normal_weight", &Agglomerative::normal_weight,
              "of 1 - cosine between normals, beside squared distances over the extent's square; 0: none", Unit::none,
              between(0, 1000)},
        Param{"balance_weight", &Agglomerative::balance_weight,
              "of the difference of areas over the larger one, beside the same; 0: trees may be lopsided", Unit::none,
              between(0, 1000)});
};

/// std::invalid_argument where a place, normal or area is not finite.
ClusteredSurfels cluster_surfels(const Agglomerative& technique, const Surfels& surfels);

}  // namespace interreflect
