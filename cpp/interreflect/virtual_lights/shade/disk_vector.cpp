#include "virtual_lights/shade/disk_vector.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "virtual_lights/shade/disk_vector.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lane_angles-inl.h"

// Roofline, for a vector of sixteen pixels: 50 operations, a square root and two divisions, all from the first cache; 250 more
// where a disk crosses the horizon of one of them.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// With height h above the disk's plane, l aside of its axis, Z = l^2 + h^2 + R^2, q = l^2 + h^2 - R^2 and S^2 = Z^2 - 4 R^2 l^2.
struct DiskPlace {
    Vec3 to, across;    // to the middle; to the middle from the receiver's foot
    Vector height, l2;  // l2: squared length of `across`
    Vector radius2, z, q, s;
};

/// Vector irradiance: along the axis (1 - q / S) / 2 = 2 R^2 h^2 / (S (S + q)), across it h / (2 l) (Z / S - 1) =
/// 2 R^2 h l / (S (S + Z)); both over the area pi R^2. The second forms do not cancel where the disk is far away.
struct DiskFlow {
    Vector along, aside;

    HWY_INLINE explicit DiskFlow(const DiskPlace& at) {
        const Vector tiny = number(1e-30f), two_h = hn::Mul(number(2.0f / pi), at.height);
        const auto outside = hn::Gt(at.q, hn::Zero(Tag()));
        along = hn::Div(hn::IfThenElse(outside, hn::Mul(two_h, at.height), hn::Mul(hn::Sub(at.s, at.q), number(0.5f / pi))),
                        hn::Max(hn::Mul(at.s, hn::IfThenElse(outside, hn::Add(at.s, at.q), at.radius2)), tiny));
        aside = hn::Div(two_h, hn::Max(hn::Mul(at.s, hn::Add(at.s, at.z)), tiny));
    }
    HWY_INLINE Vector received(const DiskPlace& at, const Vec3& facing, const Vec3& n) const {
        return hn::NegMulAdd(along, dot(n, facing), hn::Mul(aside, dot(n, at.across)));
    }
};

/// How a plane through the receiver cuts the disk.
struct Horizon {
    Vector slope, sine, middle,
        reach;  // n . facing; its sine; of the disk's middle and of its rim over the middle, heights above

    HWY_INLINE Horizon(const DiskPlace& at, const Vec3& facing, const Vec3& n) {
        slope = dot(n, facing);
        const Vec3 steepest = moved(n, facing, hn::Neg(slope));  // in the disk's plane
        sine = hn::Sqrt(dot(steepest, steepest));
        middle = dot(at.to, n);
        reach = hn::Mul(sine, hn::Sqrt(at.radius2));
    }
    HWY_INLINE Vector highest() const { return hn::Add(middle, reach); }
    HWY_INLINE LaneMask crosses() const { return hn::Lt(hn::Abs(middle), reach); }
};

/// Form factor of the part of the disk above a horizon that crosses it. Lambert's integral of n . (r x dr) / r^2 over its border
/// is, with n1, n2 and n3 the normal's parts along `across`, in the disk's plane at right angles to that, and along `facing`, and
/// the angle p about the middle,
///
///   R (n3 R + (n3 l + n1 h) cos p + n2 h sin p) / (Z + 2 R l cos p)
///
/// over the arc, which has elementary integrals, and over the chord the angle that it spans, as it lies in the horizon.
HWY_INLINE Vector cut_disk(const DiskPlace& at, const Horizon& horizon, const Vec3& n) {
    const Tag d;
    const Vector one = number(1.0f), two = number(2.0f), tiny = number(1e-12f);
    const Vector radius = hn::Sqrt(at.radius2), h = at.height;
    const Vector l = hn::Max(hn::Sqrt(at.l2), hn::Mul(radius, number(1e-6f)));
    const Vector n3 = horizon.slope, tilt = hn::Max(horizon.sine, number(1e-6f)), n1 = hn::Div(dot(n, at.across), l);
    const Vector s = hn::Min(one, hn::Max(number(-1.0f), hn::Div(horizon.middle, hn::Max(horizon.reach, number(1e-30f)))));
    // The arc lies within the angle of cosine -s about the direction (c0, s0) that rises most.
    const Vector sb = other_leg(s), c0 = hn::Div(n1, tilt), s0 = other_leg(hn::Min(one, hn::Abs(c0)));
    const Vector n2 = hn::Mul(s0, tilt), arc = hn::Mul(two, angle_of(sb, hn::Neg(s)));
    const Vector c1 = hn::MulSub(s0, sb, hn::Mul(c0, s)), s1 = hn::Neg(hn::MulAdd(c0, sb, hn::Mul(s0, s)));
    const Vector c2 = hn::Neg(hn::MulAdd(s0, sb, hn::Mul(c0, s))), s2 = hn::MulSub(c0, sb, hn::Mul(s0, s));
    const Vector b = hn::Mul(two, hn::Mul(l, radius)), wide = hn::Add(at.z, at.s);
    const Vector k1 = hn::Div(hn::Mul(b, s1), hn::MulAdd(b, c1, wide)), k2 = hn::Div(hn::Mul(b, s2), hn::MulAdd(b, c2, wide));
    const Vector apart = hn::Sub(k2, k1);
    const Vector turn = hn::CopySign(angle_of(hn::Abs(apart), hn::MulAdd(k1, k2, one)), apart);
    // Of 1, of cos p and of sin p, over Z + 2 R l cos p.
    const Vector of_one = hn::Div(hn::NegMulAdd(two, turn, arc), at.s);
    const Vector of_cosine = hn::Div(hn::MulSub(hn::Div(hn::Mul(two, at.z), b), turn, hn::Div(hn::Mul(arc, b), wide)), at.s);
    const Vector of_sine = hn::Div(hn::Log1p(d, hn::Div(hn::Mul(b, hn::Sub(c2, c1)), hn::MulAdd(b, c1, at.z))), hn::Neg(b));
    Vector border = hn::Mul(hn::MulAdd(n3, l, hn::Mul(n1, h)), of_cosine);
    border = hn::MulAdd(hn::Mul(n3, radius), of_one, border);
    border = hn::MulAdd(hn::Mul(n2, h), of_sine, border);
    const Vector rise = hn::Div(h, tilt), aside = hn::Mul(l, s0), half = hn::Mul(radius, sb);
    const Vector chord =
        angle_of(hn::Mul(two, hn::Mul(half, rise)), hn::MulAdd(rise, rise, hn::Mul(hn::Sub(aside, half), hn::Add(aside, half))));
    const Vector area = hn::Mul(number(2.0f * pi * pi), hn::Max(at.radius2, tiny));
    return hn::Div(hn::NegMulAdd(radius, border, chord), area);
}

void disk_vector(const DiskLight& light, const Receivers& receivers, float* result) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto load = [&](const float(*from)[Receivers::capacity], int i) HWY_ATTR {
        return Vec3{hn::Load(d, from[0] + i), hn::Load(d, from[1] + i), hn::Load(d, from[2] + i)};
    };
    const Vec3 centre = same(light.position), facing = same(light.normal);
    const Vector zero = hn::Zero(d), rounding = number(1e-4f * light.radius());
    DiskPlace at{};
    at.radius2 = number(light.area / pi);
    for (int i = 0; i < receivers.padded(); i += lanes) {
        at.to = difference(centre, load(receivers.position, i));
        at.height = hn::Neg(dot(at.to, facing));
        at.across = moved(at.to, facing, at.height);
        at.l2 = dot(at.across, at.across);
        const Vector h2 = hn::Mul(at.height, at.height), outer = hn::Add(at.l2, h2);
        at.z = hn::Add(outer, at.radius2), at.q = hn::Sub(outer, at.radius2);
        const Vector s2 = hn::MulAdd(at.q, at.q, hn::Mul(number(4.0f), hn::Mul(at.radius2, h2)));
        at.s = hn::Sqrt(hn::Max(s2, number(1e-30f)));
        const Vec3 normal = load(receivers.normal, i);
        const Horizon horizon(at, facing, normal), ground(at, facing, load(receivers.geometric_normal, i));
        const auto seen = hn::And(hn::Gt(at.height, number(light.least_height())),
                                  hn::And(hn::Gt(horizon.highest(), rounding), hn::Gt(ground.highest(), rounding)));
        Vector value = DiskFlow(at).received(at, facing, normal);
        const auto cut = hn::And(seen, horizon.crosses());
        if (!hn::AllFalse(d, cut)) value = hn::IfThenElse(cut, cut_disk(at, horizon, normal), value);
        hn::Store(hn::IfThenElseZero(seen, hn::Max(value, zero)), d, result + i);
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
