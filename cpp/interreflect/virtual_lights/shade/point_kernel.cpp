// Point, ClampedPoint, PointToDisk and MemberBoundedDisk: one light and many pixels, a vector of them at a time.
#include "virtual_lights/shade/clamped_point.h"
#include "virtual_lights/shade/disk_vector.h"
#include "virtual_lights/shade/member_bounded_disk.h"
#include "virtual_lights/shade/point.h"
#include "virtual_lights/shade/point_to_disk.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "virtual_lights/shade/point_kernel.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline, for a vector of sixteen pixels: 30 operations and a division, all from the first cache; of MemberBoundedDisk at each
// place.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Vec3 everywhere(const vec3& v) {
    const Tag d;
    return {hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)};
}
HWY_INLINE Vec3 load(const float (*from)[Receivers::capacity], int i) {
    const Tag d;
    return {hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
}

/// A disk's area adds to pi r^2; the geometry term is at most `bound`.
void point_irradiance(const DiskLight& light, const Receivers& receivers, float area, float bound, float* result) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
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

/// Holds `result`, the whole disk's, within the bound of its members'.
void bound_by_members(const DiskLight& light, const Receivers& receivers, float bound, float* result) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const MemberPlaces& places = *light.places;
    constexpr float each = 1.0f / MemberPlaces::count;
    const Vector zero = hn::Zero(d), tiny = hn::Set(d, 1e-30f), area = hn::Set(d, light.area * each);
    const Vector most = hn::Set(d, bound), least = hn::Set(d, 1.0f / bound);
    for (int i = 0; i < receivers.padded(); i += lanes) {
        const Vec3 at = load(receivers.position, i), normal = load(receivers.normal, i);
        const Vec3 ground = load(receivers.geometric_normal, i);
        Vector sum = zero;
        for (int k = 0; k < MemberPlaces::count; ++k) {
            const Vec3 place = everywhere({places.position[0][k], places.position[1][k], places.position[2][k]});
            const Vec3 facing = everywhere({places.normal[0][k], places.normal[1][k], places.normal[2][k]});
            const Vec3 to{hn::Sub(place.x, at.x), hn::Sub(place.y, at.y), hn::Sub(place.z, at.z)};
            const Vector distance2 = dot(to, to), below = dot(to, normal), above = hn::Neg(dot(to, facing));
            const auto seen = hn::And(hn::And(hn::Gt(below, zero), hn::Gt(above, zero)), hn::Gt(dot(to, ground), zero));
            const Vector over = hn::Mul(distance2, hn::MulAdd(distance2, hn::Set(d, pi), area));
            sum = hn::Add(sum, hn::IfThenElseZero(seen, hn::Div(hn::Mul(below, above), hn::Max(over, tiny))));
        }
        const Vector members = hn::Mul(sum, hn::Set(d, each)), whole = hn::Load(d, result + i);
        hn::Store(hn::Min(hn::Max(whole, hn::Mul(members, least)), hn::Mul(members, most)), d, result + i);
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
HWY_EXPORT(bound_by_members);

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
void irradiance(const MemberBoundedDisk& technique, const DiskLight& light, const Receivers& receivers, float extent,
                PerReceiver& result) {
    irradiance(DiskVector{}, light, receivers, extent, result);
    if (light.places != nullptr)
        HWY_DYNAMIC_DISPATCH(bound_by_members)(light, receivers, static_cast<float>(technique.bound), result.value);
}

}  // namespace interreflect
#endif
