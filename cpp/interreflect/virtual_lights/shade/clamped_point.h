#pragma once
#include "data/technique.h"
#include "virtual_lights/receivers.h"

namespace interreflect {

/// A point whose geometry term cos cos' / r^2 is bounded: no singularity, and less energy [Weinzierl-Heigl 2013, figure 1].
struct ClampedPoint {
    double bound = 100.0;

    bool operator==(const ClampedPoint&) const = default;
    static constexpr auto description =
        describe("ClampedPoint", "A light is a point whose geometry term is bounded.", Source{"Weinzierl-Heigl 2013", "figure 1"},
                 Param{"bound", &ClampedPoint::bound, "largest geometry term, over 1 / (diagonal of the scene's box)^2",
                       Unit::none, above(0)});
};
void irradiance(const ClampedPoint& technique, const DiskLight& light, const Receivers& receivers, float extent,
                PerReceiver& result);

}  // namespace interreflect
