// Point, ClampedPoint and PointToDisk: one light and many pixels, a vector of them at a time.
#include "virtual_lights/shade/clamped_point.h"
#include "virtual_lights/shade/point.h"
#include "virtual_lights/shade/point_to_disk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "virtual_lights/shade/point_kernel.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline, for a vector of sixteen pixels: 30 operations and a square root, all from the first cache.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A disk's area adds to pi r^2; the geometry term is at most `bound`.
void point_irradiance(const DiskLight& light, const Receivers& receivers, float area, float bound, float* result) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto load = [&](const float(*from)[Receivers::capacity], int i) HWY_ATTR {
        return Vec3{hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
    };
    const auto everywhere = [&](const vec3& v) HWY_ATTR { return Vec3{hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)}; };
    const Vec3 centre = everywhere(light.position), facing = everywhere(light.normal);
    const Vector zero = hn::Zero(d), tiny = hn::Set(d, 1e-30f);
    for (int i = 0; i < receivers.padded(); i += lanes) {
        const Vec3 at = load(receivers.position, i);
        const Vec3 to{hn::Sub(centre.x, at.x), hn::Sub(centre.y, at.y), hn::Sub(centre.z, at.z)};
        const Vector distance2 = hn::Max(dot(to, to), tiny);
        const Vector below = dot(to, load(receivers.normal, i)), above = hn::Neg(dot(to, facing));
        const auto seen = hn::And(hn::And(hn::Gt(below, zero), hn::Gt(above, zero)),
                                  hn::Gt(dot(to, load(receivers.geometric_normal, i)), zero));
        const Vector cosines = hn::Div(hn::Mul(below, above), distance2);
        const Vector term =
            hn::Min(hn::Div(cosines, hn::MulAdd(distance2, hn::Set(d, pi), hn::Set(d, area))), hn::Set(d, bound / pi));
        hn::Store(hn::IfThenElseZero(seen, term), d, result + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
namespace {
constexpr float unbounded = 3e38f;
}
HWY_EXPORT(point_irradiance);

void irradiance(const Point&, const DiskLight& light, const Receivers& receivers, float, PerReceiver& result) {
    HWY_DYNAMIC_DISPATCH(point_irradiance)(light, receivers, 0.0f, unbounded, result.value);
}
void irradiance(const ClampedPoint& technique, const DiskLight& light, const Receivers& receivers, float extent,
                PerReceiver& result) {
    const float bound = static_cast<float>(technique.bound) / (extent * extent);
    HWY_DYNAMIC_DISPATCH(point_irradiance)(light, receivers, 0.0f, bound, result.value);
}
void irradiance(const PointToDisk&, const DiskLight& light, const Receivers& receivers, float, PerReceiver& result) {
    HWY_DYNAMIC_DISPATCH(point_irradiance)(light, receivers, light.area, unbounded, result.value);
}

}  // namespace interreflect
#endif
