#pragma once
#include "data/technique.h"
#include "virtual_lights/receivers.h"

namespace interreflect {

/// The form factor of a disk from its middle, A cos cos' / (pi r^2 + A): exact on the axis of parallel surfaces, too small off
/// it. The paper's equation 2 lacks the A in the numerator: it is for flux, where A and the radiosity's 1 / A cancel (ERRATA.md).
struct PointToDisk {
    bool operator==(const PointToDisk&) const = default;
    static constexpr auto description = describe("PointToDisk", "A light is a disk, seen from its middle.",
                                                 Source{"Wallace et al. 1989; Weinzierl-Heigl 2013", "equation 2, corrected"});
};
void irradiance(const PointToDisk&, const DiskLight& light, const Receivers& receivers, float extent, PerReceiver& result);

}  // namespace interreflect
