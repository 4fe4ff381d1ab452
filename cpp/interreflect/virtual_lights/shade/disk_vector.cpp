#include "virtual_lights/shade/disk_vector.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "virtual_lights/shade/disk_vector.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline, for a vector of sixteen pixels: 45 operations, a square root and two divisions, all from the first cache.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// With height h above the disk's plane, l aside of its axis, Z = l^2 + h^2 + R^2, q = l^2 + h^2 - R^2 and S^2 = Z^2 - 4 R^2 l^2:
// along the axis (1 - q / S) / 2 = 2 R^2 h^2 / (S (S + q)), across it h / (2 l) (Z / S - 1) = 2 R^2 h l / (S (S + Z)); both over
// the area pi R^2. The second forms do not cancel where the disk is far away.
void disk_vector(const DiskLight& light, const Receivers& receivers, float* result) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto load = [&](const float(*from)[Receivers::capacity], int i) HWY_ATTR {
        return Vec3{hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
    };
    const auto everywhere = [&](const vec3& v) HWY_ATTR { return Vec3{hn::Set(d, v.x), hn::Set(d, v.y), hn::Set(d, v.z)}; };
    const Vec3 centre = everywhere(light.position), facing = everywhere(light.normal);
    const Vector zero = hn::Zero(d), tiny = hn::Set(d, 1e-30f), radius2 = hn::Set(d, light.area / pi);
    for (int i = 0; i < receivers.padded(); i += lanes) {
        const Vec3 at = load(receivers.position, i);
        const Vec3 to{hn::Sub(centre.x, at.x), hn::Sub(centre.y, at.y), hn::Sub(centre.z, at.z)};
        const Vector height = hn::Neg(dot(to, facing));
        const Vec3 across = moved(to, facing, height);  // from the foot of the receiver to the middle
        const Vector l2 = dot(across, across), h2 = hn::Mul(height, height);
        const Vector z = hn::Add(hn::Add(l2, h2), radius2), q = hn::Sub(hn::Add(l2, h2), radius2);
        const Vector s = hn::Sqrt(hn::Max(hn::MulAdd(q, q, hn::Mul(hn::Set(d, 4.0f), hn::Mul(radius2, h2))), tiny));
        const Vector two_h = hn::Mul(hn::Set(d, 2.0f / pi), height);
        const auto outside = hn::Gt(q, zero);
        const Vector along =
            hn::Div(hn::IfThenElse(outside, hn::Mul(two_h, height), hn::Mul(hn::Sub(s, q), hn::Set(d, 0.5f / pi))),
                    hn::Max(hn::Mul(s, hn::IfThenElse(outside, hn::Add(s, q), radius2)), tiny));
        const Vector aside = hn::Div(two_h, hn::Max(hn::Mul(s, hn::Add(s, z)), tiny));
        const auto received = [&](const Vec3& n)
                                  HWY_ATTR { return hn::NegMulAdd(along, dot(n, facing), hn::Mul(aside, dot(n, across))); };
        const Vector value = received(load(receivers.normal, i));
        const auto seen = hn::And(hn::And(hn::Gt(height, hn::Set(d, light.least_height())), hn::Gt(value, zero)),
                                  hn::Gt(received(load(receivers.geometric_normal, i)), zero));
        hn::Store(hn::IfThenElseZero(seen, value), d, result + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(disk_vector);

void irradiance(const DiskVector&, const DiskLight& light, const Receivers& receivers, float, PerReceiver& result) {
    HWY_DYNAMIC_DISPATCH(disk_vector)(light, receivers, result.value);
}

}  // namespace interreflect
#endif
