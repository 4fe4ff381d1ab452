#pragma once
#include "data/technique.h"
#include "virtual_lights/receivers.h"

namespace interreflect {

/// The disk's vector irradiance in closed form: its part along the disk's axis is the form factor of a parallel receiver, its
/// part across that of a perpendicular one. Where the disk crosses the receiver's horizon, Lambert's integral along the arc and
/// the chord of what is above.
struct DiskVector {
    bool operator==(const DiskVector&) const = default;
    static constexpr auto description =
        describe("DiskVector", "A light is a disk, cut at the receiver's horizon; in closed form.",
                 Source{"Howell 2010; Gershun 1939; Lambert 1760", "configurations B-12 and B-13; light field"});
};
void irradiance(const DiskVector&, const DiskLight& light, const Receivers& receivers, float extent, PerReceiver& result);

}  // namespace interreflect
