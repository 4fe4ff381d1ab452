#pragma once
#include "data/technique.h"
#include "virtual_lights/receivers.h"

namespace interreflect {

/// The disk's vector irradiance in closed form: its part along the disk's axis is the form factor of a parallel receiver, its
/// part across that of a perpendicular one. Exact wherever the whole disk stands above the receiver's horizon; what is below is
/// counted negative.
struct DiskVector {
    bool operator==(const DiskVector&) const = default;
    static constexpr auto description =
        describe("DiskVector", "A light is a disk; exact while all of it is above the receiver's horizon.",
                 Source{"Howell 2010; Gershun 1939", "configurations B-12 and B-13; light field"});
};
void irradiance(const DiskVector&, const DiskLight& light, const Receivers& receivers, float extent, PerReceiver& result);

}  // namespace interreflect
