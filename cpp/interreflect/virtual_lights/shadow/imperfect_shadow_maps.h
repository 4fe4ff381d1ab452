#pragma once
#include <string>

#include "data/scene.h"
#include "data/technique.h"
#include "data/virtual_lights.h"

namespace interreflect {

/// Points on the scene's triangles, dealt to the lights' maps in turn; each is drawn as large as the surface that it stands for
/// looks from there. Texels between points are filled from coarser levels.
struct ImperfectShadowMaps {
    int size = 128;
    int points = 100'000;
    int iterations = 2;
    double point_size = 1.25;
    std::string splat = "disk";
    double bias = 1.0;

    bool operator==(const ImperfectShadowMaps&) const = default;
    static constexpr auto description = describe(
        "ImperfectShadowMaps",
        "Paraboloid shadow maps of points on the scene's surface, each map of a part of them, with holes filled.",
        Source{"Ritschel et al. 2008; Weinzierl-Heigl 2013", "5"},
        Param{"size", &ImperfectShadowMaps::size, "side of each light's map; all together hold at most 4096^2 texels",
              Unit::texels, between(1, 4096)},
        Param{"points", &ImperfectShadowMaps::points, "on the whole scene, by area; each is in one map only", Unit::none,
              between(0, 1 << 26)},
        Param{"iterations", &ImperfectShadowMaps::iterations, "levels of pulling and pushing that fill holes", Unit::none,
              between(0, 12)},
        Param{
            "point_size", &ImperfectShadowMaps::point_size,
            "of a point's disk, over that with the share of the surface that a map's point stands for: disks of size s at random "
            "places leave exp(-s^2) of a surface open",
            Unit::diameters, above(0)},
        Param{"splat", &ImperfectShadowMaps::splat,
              "how a point is drawn: as a disk on its surface, or as in the paper a square of one depth", Unit::none,
              one_of("disk|square")},
        Param{"bias", &ImperfectShadowMaps::bias,
              "how much nearer to the light something must be to cast a shadow, in diameters of a point's disk", Unit::diameters,
              at_least(0)});
};

/// The points of a scene: the same for any number of lights. Body poses may change later, the surface may not.
SurfacePoints scatter_points(const ImperfectShadowMaps& technique, const Scene& scene);

/// std::invalid_argument where the maps would have more than 4096 x 4096 texels, and for points of another scene.
LightShadows shadow_lights(const ImperfectShadowMaps& technique, const VirtualLights& lights, const SurfacePoints& points,
                           const Scene& scene);

}  // namespace interreflect
