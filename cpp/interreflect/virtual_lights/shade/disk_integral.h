#pragma once
#include "data/technique.h"
#include "virtual_lights/receivers.h"

namespace interreflect {

/// The exact form factor of the part of the disk above the receiver's horizon: Lambert's sum over the edges of a polygon of the
/// disk's area, with so many sides that it departs from the disk by less than a thousandth.
struct DiskIntegral {
    bool operator==(const DiskIntegral&) const = default;
    static constexpr auto description = describe("DiskIntegral", "The exact form factor of a light's disk, cut at the horizon.",
                                                 Source{"Lambert 1760; Baum et al. 1989", "equation 9"});
};
void irradiance(const DiskIntegral&, const DiskLight& light, const Receivers& receivers, float extent, PerReceiver& result);

}  // namespace interreflect
