// Frames and angles of vectors of lanes. Included once for every vector target.
#if defined(INTERREFLECT_LANE_ANGLES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_LANE_ANGLES
#undef INTERREFLECT_LANE_ANGLES
#else
#define INTERREFLECT_LANE_ANGLES
#endif

#include <hwy/contrib/math/math-inl.h>

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE Vector number(float value) { return hn::Set(Tag(), value); }
HWY_INLINE Vec3 same(const vec3& v) { return {number(v.x), number(v.y), number(v.z)}; }
HWY_INLINE Vec3 sum(const Vec3& a, const Vec3& b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
HWY_INLINE Vec3 difference(const Vec3& a, const Vec3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE Vec3 product(const Vec3& a, const Vec3& b) { return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)}; }
HWY_INLINE Vec3 unit(const Vec3& a) { return scaled(a, hn::Div(number(1.0f), hn::Sqrt(dot(a, a)))); }
HWY_INLINE Vector largest(const Vec3& a) { return hn::Max(a.x, hn::Max(a.y, a.z)); }
/// sqrt(1 - x^2) of a cosine or sine that rounding may have left a little beyond 1.
HWY_INLINE Vector other_leg(Vector x) { return hn::Sqrt(hn::Max(hn::Zero(Tag()), hn::NegMulAdd(x, x, number(1.0f)))); }

/// Angle in [0, pi] of the direction (x, y), y not negative; off by at most 4 units in the last place.
HWY_INLINE Vector angle_of(Vector y, Vector x) {
    const Tag d;
    const Vector along = hn::Abs(x), larger = hn::Max(along, y), smaller = hn::Min(along, y);
    const Vector turned = hn::Atan(d, hn::Div(smaller, hn::Max(larger, number(1e-37f))));
    const Vector upright = hn::IfThenElse(hn::Gt(y, along), hn::Sub(number(pi / 2.0f), turned), turned);
    return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(number(pi), upright), upright);
}

struct SineCosine {
    Vector sine, cosine;
};
/// Of angles in [-pi/4, pi/4]; off by at most 1e-7 [Cephes, sinf.c].
HWY_INLINE SineCosine sine_cosine_octant(Vector angle) {
    const Vector x2 = hn::Mul(angle, angle);
    const Vector s =
        hn::MulAdd(hn::MulAdd(number(-1.9515295891e-4f), x2, number(8.3321608736e-3f)), x2, number(-1.6666654611e-1f));
    const Vector c = hn::MulAdd(hn::MulAdd(number(2.443315711809948e-5f), x2, number(-1.388731625493765e-3f)), x2,
                                number(4.166664568298827e-2f));
    return {hn::MulAdd(hn::Mul(s, x2), angle, angle),
            hn::MulAdd(hn::Mul(c, x2), x2, hn::NegMulAdd(number(0.5f), x2, number(1.0f)))};
}

/// cosine_hemisphere of sampling.h.
HWY_INLINE Vec3 cosine_hemisphere_lanes(Vector u, Vector v) {
    const Tag d;
    const Vector x = hn::MulAdd(number(2.0f), u, number(-1.0f)), y = hn::MulAdd(number(2.0f), v, number(-1.0f));
    const auto wide = hn::Gt(hn::Abs(x), hn::Abs(y));
    const Vector radius = hn::IfThenElse(wide, x, y), other = hn::IfThenElse(wide, y, x);
    const Vector some = hn::IfThenElse(hn::Eq(radius, hn::Zero(d)), number(1.0f), radius);
    const SineCosine turn = sine_cosine_octant(hn::Mul(number(pi / 4.0f), hn::Div(other, some)));
    const Vector near = hn::Mul(radius, turn.cosine), far = hn::Mul(radius, turn.sine);
    return {hn::IfThenElse(wide, near, far), hn::IfThenElse(wide, far, near), other_leg(radius)};
}

/// Frame(normal).to_world(v) of vectors.h.
HWY_INLINE Vec3 to_world(const Vec3& n, const Vec3& v) {
    const Vector one = number(1.0f), sign = hn::CopySign(one, n.z);
    const Vector a = hn::Div(number(-1.0f), hn::Add(sign, n.z)), b = hn::Mul(hn::Mul(n.x, n.y), a);
    const Vec3 tangent{hn::MulAdd(hn::Mul(sign, n.x), hn::Mul(n.x, a), one), hn::Mul(sign, b), hn::Neg(hn::Mul(sign, n.x))};
    const Vec3 bitangent{b, hn::MulAdd(hn::Mul(n.y, n.y), a, sign), hn::Neg(n.y)};
    return moved(moved(scaled(tangent, v.x), bitangent, v.y), n, v.z);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
