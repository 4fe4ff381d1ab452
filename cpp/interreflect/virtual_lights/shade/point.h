#pragma once
#include "data/technique.h"
#include "virtual_lights/receivers.h"

namespace interreflect {

/// A light is a point: cos cos' / (pi r^2), which has no bound.
struct Point {
    bool operator==(const Point&) const = default;
    static constexpr auto description = describe("Point", "A light is a point.", Source{"Keller 1997"});
};
void irradiance(const Point&, const DiskLight& light, const Receivers& receivers, float extent, PerReceiver& result);

}  // namespace interreflect
