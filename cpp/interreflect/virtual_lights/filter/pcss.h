#pragma once
#include "data/technique.h"
#include "virtual_lights/filter/shadowed_light.h"

namespace interreflect {

/// Soft shadows of a disk as if light, blocker and pixel lay in parallel planes: the mean depth of what blocks gives the width of
/// the penumbra, (z_receiver - z_blocker) / z_blocker times the light's [equation 3], and lookups are spread over as much of the
/// map. Depths are planar, along the light's normal: recovered from the map's radial ones (ERRATA.md). The light's radius is
/// sqrt(area / pi). Lookups are left out where they would tell nothing new: a pixel without blockers is lit, one whose whole
/// search is blocked is not, unless its penumbra is wider than the search, and where the first half of the penumbra's lookups
/// agree the other half is left out [Uralsky 2005, GPU Gems 2, 17].
struct Pcss {
    int blocker_samples = 8;
    int filter_samples = 16;
    double nearest_blocker = 0.25;

    bool operator==(const Pcss&) const = default;
    static constexpr auto description = describe(
        "Pcss", "Percentage-closer soft shadows: lookups spread as wide as the penumbra of the light's disk.",
        Source{"Fernando 2005; Weinzierl-Heigl 2013", "6, equation 3"},
        Param{"blocker_samples", &Pcss::blocker_samples, "lookups in search of blockers", Unit::samples, between(1, 64)},
        Param{"filter_samples", &Pcss::filter_samples, "lookups in the penumbra", Unit::samples, between(1, 64)},
        Param{"nearest_blocker", &Pcss::nearest_blocker,
              "how near to the light blockers are searched for, as a share of the pixel's distance: the search is as wide "
              "as the penumbra would be",
              Unit::none, Range{0.01, 0.99}});
};
void visibility(const Pcss& technique, const ShadowedLight& light, const Receivers& receivers, const PerReceiver& irradiance,
                std::uint32_t seed, PerReceiver& visible, Counts& counts);

}  // namespace interreflect
