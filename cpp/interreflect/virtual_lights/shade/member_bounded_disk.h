#pragma once
#include "data/technique.h"
#include "virtual_lights/receivers.h"

namespace interreflect {

/// DiskVector, held near to what small disks at the light's members would bring, each of an equal part of its flux and area and
/// seen from its middle (PointToDisk). A cluster's flat disk reaches past edges of what its members lie on, where it is below
/// horizons that they are above, or near to what they are far from. Beside a light its few members are dots, which the disk is
/// not: only where the two differ by more than the bound is the disk wrong. A light that stands for one texel, or that a user
/// placed, is its disk.
struct MemberBoundedDisk {
    double bound = 5.0;

    bool operator==(const MemberBoundedDisk&) const = default;
    static constexpr auto description =
        describe("MemberBoundedDisk", "A light is a disk that brings about as much as sixteen of its members would.",
                 Source{"Wallace et al. 1989", "form factors of the members"},
                 Param{"bound", &MemberBoundedDisk::bound,
                       "largest ratio between what the disk brings and its members do, either way", Unit::none, at_least(1)});
};
void irradiance(const MemberBoundedDisk& technique, const DiskLight& light, const Receivers& receivers, float extent,
                PerReceiver& result);

}  // namespace interreflect
