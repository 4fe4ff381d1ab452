#pragma once
#include <variant>

#include "caches/distribute/clustered.h"
#include "caches/distribute/cube_face_clustered.h"
#include "caches/distribute/equidistant.h"
#include "data/technique.h"

namespace interreflect {

/// Last frame's caches stay where they are while they are seen [Rehfeld et al. 2014, 6; after Laine et al. 2007]; they are sorted
/// into this frame's clusters [Wang et al. 2009], and clusters that get none have a new one placed, where none that stays is
/// near.
///
/// A cache rides on its instance. It is valid where the pixel that it projects to sees its surface: the same body, not far off
/// the plane through the cache, with a similar normal. Of too many in a cluster those that lasted longest stay. Only places are
/// kept; what arrives there is gathered anew. Tiles keep the last frame's size while their clusters are about as many as are
/// wanted. Tiles stand still while surfaces pass below them: with one cache a cluster, neither more nor less, a cache would go
/// whenever it comes into the next one's cluster, and another would come where it was.
struct ReuseCaches {
    std::variant<Clustered, CubeFaceClustered, Equidistant> distribute;
    int most = 4;
    double spacing = 0.5;
    double max_distance = 0.1;
    double max_angle = 30.0;
    double tolerance = 0.25;

    bool operator==(const ReuseCaches&) const = default;
    static constexpr auto description = describe(
        "ReuseCaches", "Last frame's caches stay where they are while they are seen; clusters without one get a new one.",
        Source{"Rehfeld et al. 2014, 6; Wang et al. 2009; Laine et al. 2007"},
        Param{"distribute", &ReuseCaches::distribute, "how pixels are put into clusters, and where new caches stand"},
        Param{"most", &ReuseCaches::most, "last frame's caches that stay in one cluster, at most", Unit::none, between(1, 64)},
        Param{
            "spacing", &ReuseCaches::spacing,
            "how near a cache that stays must stand to where a cluster would get a new one for it to need none, in lengths of a "
            "tile on the surface; 0: every cluster has its own",
            Unit::tiles, between(0, 4)},
        Param{"max_distance", &ReuseCaches::max_distance,
              "how far off a cache's plane the surface seen there may lie, in widths of a tile at its distance", Unit::tiles,
              between(0, 16)},
        Param{"max_angle", &ReuseCaches::max_angle, "largest angle between a cache's normal and the one seen there",
              Unit::degrees, between(0, 90)},
        Param{"tolerance", &ReuseCaches::tolerance,
              "by which share clusters may be more, or fewer, than the caches that are wanted, before tiles get another size",
              Unit::none, between(0, 16)});
};

/// Throws std::invalid_argument where `last` is another technique's.
CachePlaces distribute(const ReuseCaches& technique, const GBuffer& gbuffer, const Scene& scene, const CachePlaces* last);

}  // namespace interreflect
