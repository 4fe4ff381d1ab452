#pragma once
#include <string>

#include "data/technique.h"
#include "data/virtual_lights.h"
#include "direct/reflective_shadow_map.h"

namespace interreflect {

/// Texels go to the nearest centre whose splat covers them, by the paper's metric
///
///   mu = w_p |x - x'| / extent + w_n (1 - n . n') + w_f |flux - flux'| / (largest flux of the map)
///
/// with weights scaled to sum up to 1 and the extent of all that the maps see; then centres move to the mean of their texels,
/// weighted by flux. Where there are several maps, which see the same surfaces, every centre may win every texel. The paper
/// prints abs(n . n') for the normals' distance, which is largest where they agree (ERRATA.md). Texels that no splat covers go to
/// the nearest centre of all, so no flux is lost; they are counted (`stray_texels`). A centre without texels starts anew at the
/// furthest texel of a cluster that has most (the paper draws another point of Halton's sequence).
struct KMeans {
    int splat_size = 128;
    double position_weight = 0.6;
    double normal_weight = 0.4;
    double flux_weight = 0.0;
    int iterations = 3;
    std::string flux = "members";
    std::string centre = "member";
    std::string area = "spread";

    bool operator==(const KMeans&) const = default;
    static constexpr auto description = describe(
        "KMeans", "Clusters of texels about centres that move to their texels' mean, from frame to frame.",
        Source{"Weinzierl-Heigl 2013", "4, equation 1, corrected"},
        Param{"splat_size", &KMeans::splat_size, "side of the square of texels that a centre may win", Unit::texels,
              between(1, 1 << 14)},
        Param{"position_weight", &KMeans::position_weight, "of distance in space, relative to the other weights", Unit::none,
              at_least(0)},
        Param{"normal_weight", &KMeans::normal_weight, "of the normals' distance", Unit::none, at_least(0)},
        Param{"flux_weight", &KMeans::flux_weight, "of the fluxes' distance", Unit::none, at_least(0)},
        Param{"iterations", &KMeans::iterations, "in every frame; each takes up where the last one ended", Unit::none,
              between(1, 1000)},
        Param{"flux", &KMeans::flux,
              "the sum of the members' flux, or as in the paper that of the centre's texel times their number", Unit::none,
              one_of("members|centre")},
        Param{"centre", &KMeans::centre,
              "where a light stands: flush with the surface of the member that is most like the members' mean in place and "
              "normal, or as in the paper at the mean itself, with its normal",
              Unit::none, one_of("member|mean")},
        Param{"area", &KMeans::area,
              "a light's: that of the disk over which flux is spread as over the members, but no more than theirs; "
              "or the sum of theirs, as in the paper (several maps that see one surface count it several times)",
              Unit::none, one_of("spread|texels")});
};

VirtualLights cluster_lights(const KMeans& technique, const VirtualLights& seeds, const LightMaps& maps,
                             const VirtualLights* last, std::uint32_t seed);

}  // namespace interreflect
