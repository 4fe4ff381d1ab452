/// Shade: how much of a virtual light's flux arrives at pixels, were nothing in between?
///
///   void irradiance(const Technique&, const DiskLight&, const Receivers&, float extent, PerReceiver&);
///
/// Irradiance of unit flux, 1/m^2; 0 behind the light, below the pixel's horizon and below its geometric one. `extent`: diagonal
/// of the scene's box. Exact counterpart: DiskIntegral.
#pragma once
#include <variant>

#include "virtual_lights/shade/clamped_point.h"
#include "virtual_lights/shade/disk_integral.h"
#include "virtual_lights/shade/disk_vector.h"
#include "virtual_lights/shade/member_bounded_disk.h"
#include "virtual_lights/shade/point.h"
#include "virtual_lights/shade/point_to_disk.h"

namespace interreflect {
using ShadeLights = std::variant<DiskIntegral, DiskVector, MemberBoundedDisk, PointToDisk, ClampedPoint, Point>;

/// Whether a glossy lobe sees a light as a disk, or as a point.
inline bool is_disk(const ShadeLights& technique) {
    return !std::holds_alternative<Point>(technique) && !std::holds_alternative<ClampedPoint>(technique);
}
}  // namespace interreflect
