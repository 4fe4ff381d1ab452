// Emitters weighed and sampled from many points at once. Included once for every vector target.
#if defined(INTERREFLECT_EMITTER_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_EMITTER_KERNEL
#undef INTERREFLECT_EMITTER_KERNEL
#else
#define INTERREFLECT_EMITTER_KERNEL
#endif

#include "math/lane_angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// LightDirection of sixteen points.
struct LightLanes {
    Vec3 direction;
    Vector distance;
    Vec3 radiance;
    Vector pdf;
};

/// Solid angle of a triangle whose corners lie along unit vectors [van Oosterom and Strackee 1983].
HWY_INLINE Vector triangle_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vector volume = hn::Abs(dot(a, cross(difference(b, a), difference(c, a))));
    const Vector sum = hn::Add(number(1.0f), hn::Add(dot(a, b), hn::Add(dot(b, c), dot(a, c))));
    return hn::Mul(number(2.0f), angle_of(volume, sum));
}

/// A direction uniform in that solid angle [Arvo 1995]. Fit for solid angles from 1e-3 sr to less than 2 pi: below, the sum of
/// the angles loses its digits.
HWY_INLINE Vec3 sample_spherical_triangle(const Vec3& a, const Vec3& b, const Vec3& c, Vector u, Vector v) {
    const Tag d;
    const auto between = [](const Vec3& p, const Vec3& q) HWY_ATTR {
        const Vec3 across = cross(p, q);
        return angle_of(hn::Sqrt(dot(across, across)), dot(p, q));
    };
    const auto orthogonal = [](const Vec3& p, const Vec3& q) HWY_ATTR { return unit(moved(p, q, hn::Neg(dot(p, q)))); };
    const Vec3 n_ab = unit(cross(a, b)), n_bc = unit(cross(b, c)), n_ca = unit(cross(c, a));
    const Vector alpha = between(n_ab, negated(n_ca)), beta = between(n_bc, negated(n_ab)), gamma = between(n_ca, negated(n_bc));
    const Vector area = hn::Mul(u, hn::Sub(hn::Add(alpha, hn::Add(beta, gamma)), number(pi)));  // of the part a, b, c'
    const Vector cos_alpha = hn::Cos(d, alpha), sin_alpha = hn::Sin(d, alpha);
    const Vector cos_area = hn::Cos(d, area), sin_area = hn::Sin(d, area);
    const Vector sin_phi = hn::Sub(hn::Mul(cos_area, sin_alpha), hn::Mul(sin_area, cos_alpha));  // phi = area + pi - alpha
    const Vector cos_phi = hn::Neg(hn::MulAdd(cos_area, cos_alpha, hn::Mul(sin_area, sin_alpha)));
    const Vector k1 = hn::Add(cos_phi, cos_alpha), k2 = hn::NegMulAdd(sin_alpha, dot(a, b), sin_phi);
    const Vector numerator = hn::MulAdd(hn::Sub(hn::Mul(cos_phi, k2), hn::Mul(sin_phi, k1)), cos_alpha, k2);
    const Vector denominator = hn::Mul(hn::MulAdd(sin_phi, k2, hn::Mul(cos_phi, k1)), sin_alpha);
    const auto flat = hn::Eq(denominator, hn::Zero(d));
    const Vector ratio = hn::IfThenElse(flat, number(1.0f), hn::Div(numerator, denominator));
    const Vector cos_b = hn::Max(number(-1.0f), hn::Min(ratio, number(1.0f)));
    const Vec3 c_part = moved(scaled(a, cos_b), orthogonal(c, a), other_leg(cos_b));
    const Vector cos_theta = hn::NegMulAdd(v, hn::Sub(number(1.0f), dot(c_part, b)), number(1.0f));
    return unit(moved(scaled(b, cos_theta), orthogonal(c_part, b), other_leg(cos_theta)));
}

/// A rectangle as seen from a point, in its own axes; z is the distance of its plane. Angles as in [Urena et al. 2013].
struct SeenRectangle {
    Vector x0, x1, y0, y1, z;
    Vector b0, b1, k, angle;
};
HWY_INLINE SeenRectangle see_rectangle(const Vec3& corner, const vec3& axis1, float length1, const vec3& axis2, float length2,
                                       Vector height) {
    const Tag d;
    SeenRectangle r;
    r.x0 = dot(corner, same(axis1)), r.y0 = dot(corner, same(axis2));
    r.x1 = hn::Add(r.x0, number(length1)), r.y1 = hn::Add(r.y0, number(length2));
    r.z = hn::Neg(height);
    // z components of the unit normals of the four planes through the point and an edge
    const Vector z2 = hn::Mul(r.z, r.z);
    const auto part = [&](Vector e) HWY_ATTR { return hn::Div(e, hn::Sqrt(hn::MulAdd(e, e, z2))); };
    const Vector n0 = hn::Neg(part(r.y0)), n1 = part(r.x1), n2 = part(r.y1), n3 = hn::Neg(part(r.x0));
    const auto angle = [&](Vector p, Vector q) HWY_ATTR {
        return hn::Acos(d, hn::Max(number(-1.0f), hn::Min(hn::Neg(hn::Mul(p, q)), number(1.0f))));
    };
    const Vector g0 = angle(n0, n1), g1 = angle(n1, n2), g2 = angle(n2, n3), g3 = angle(n3, n0);
    r.b0 = n0, r.b1 = n2;
    r.k = hn::Sub(number(2.0f * pi), hn::Add(g2, g3));
    r.angle = hn::Sub(hn::Add(g0, g1), r.k);
    return r;
}

/// A point of it in its own axes, relative to the viewer, uniform in the solid angle [Urena et al. 2013, figure 4].
HWY_INLINE Vec3 sample_seen_rectangle(const SeenRectangle& r, Vector u, Vector v) {
    const Tag d;
    const Vector one = number(1.0f), turn = hn::MulAdd(u, r.angle, r.k);
    const Vector sine = hn::Sin(d, turn), cosine = hn::Cos(d, turn);
    const Vector f = hn::Div(hn::MulSub(cosine, r.b0, r.b1), sine);
    const Vector c = hn::CopySign(hn::Div(one, hn::Sqrt(hn::MulAdd(f, f, hn::Mul(r.b0, r.b0)))), f);
    const Vector cu = hn::Max(number(-1.0f), hn::Min(c, one));
    const Vector leg = hn::Max(other_leg(cu), number(1e-7f));
    const Vector x = hn::Max(r.x0, hn::Min(hn::Neg(hn::Div(hn::Mul(cu, r.z), leg)), r.x1));
    const Vector d2 = hn::MulAdd(x, x, hn::Mul(r.z, r.z));
    const Vector h0 = hn::Div(r.y0, hn::Sqrt(hn::MulAdd(r.y0, r.y0, d2)));
    const Vector h1 = hn::Div(r.y1, hn::Sqrt(hn::MulAdd(r.y1, r.y1, d2)));
    const Vector h = hn::MulAdd(v, hn::Sub(h1, h0), h0);
    const Vector y = hn::Mul(h, hn::Sqrt(hn::Div(d2, hn::Max(hn::NegMulAdd(h, h, one), number(1e-7f)))));
    return {x, hn::Max(r.y0, hn::Min(y, r.y1)), r.z};
}

/// A shape as seen from points.
struct SeenShape {
    Vec3 to_corner;
    Vector height;  // of the points above its plane
    LaneMask near;
    Vector angle;  // solid angle; far away that of a small one; 0 from behind
    SeenRectangle rectangle;
};

HWY_INLINE SeenShape see_shape(const EmitterShape& shape, const Vec3& position) {
    const Tag d;
    SeenShape s;
    s.to_corner = difference(same(shape.corner), position);
    s.height = hn::Neg(dot(s.to_corner, same(shape.normal)));
    const Vec3 middle = sum(s.to_corner, same(shape.to_middle));
    const Vector distance2 = dot(middle, middle);
    const auto lit = hn::Gt(s.height, hn::Zero(d));
    s.angle = hn::Div(hn::Mul(number(shape.area), s.height), hn::Mul(distance2, hn::Sqrt(distance2)));
    s.near = hn::And(lit, hn::Lt(distance2, number(shape.near2)));
    if (!hn::AllFalse(d, s.near)) {
        Vector exact;
        if (shape.rectangle) {
            const float length1 = glm::length(shape.edge1), length2 = glm::length(shape.edge2);
            s.rectangle = see_rectangle(s.to_corner, shape.edge1 / length1, length1, shape.edge2 / length2, length2, s.height);
            exact = s.rectangle.angle;
        } else {
            exact = triangle_angle(unit(s.to_corner), unit(sum(s.to_corner, same(shape.edge1))),
                                   unit(sum(s.to_corner, same(shape.edge2))));
        }
        // Seen edge-on a solid angle has no digits left: sampled by area.
        s.near = hn::And(s.near, hn::Gt(exact, number(1e-3f)));
        s.angle = hn::IfThenElse(s.near, exact, s.angle);
    }
    s.angle = hn::IfThenElseZero(lit, s.angle);
    return s;
}

/// A light that has a direction and, for far lanes, a density; near ones have 1 / solid angle.
HWY_INLINE LightLanes sample_shape(const EmitterShape& shape, const SeenShape& s, Vector u, Vector v) {
    const Tag d;
    const Vector root = hn::Sqrt(u);
    const Vector b1 = shape.rectangle ? u : hn::Sub(number(1.0f), root), b2 = shape.rectangle ? v : hn::Mul(v, root);
    Vec3 to = moved(moved(s.to_corner, same(shape.edge1), b1), same(shape.edge2), b2);
    if (!hn::AllFalse(d, s.near)) {
        Vec3 near;
        if (shape.rectangle) {
            const Vec3 local = sample_seen_rectangle(s.rectangle, u, v);
            const vec3 axis1 = shape.edge1 / glm::length(shape.edge1), axis2 = shape.edge2 / glm::length(shape.edge2);
            near = moved(moved(scaled(same(axis1), local.x), same(axis2), local.y), same(shape.normal), local.z);
        } else {
            const Vec3 direction = sample_spherical_triangle(unit(s.to_corner), unit(sum(s.to_corner, same(shape.edge1))),
                                                             unit(sum(s.to_corner, same(shape.edge2))), u, v);
            near = scaled(direction, hn::Div(hn::Neg(s.height), dot(direction, same(shape.normal))));
        }
        to = choose(s.near, near, to);
    }
    const Vector distance2 = dot(to, to), distance = hn::Sqrt(distance2);
    // The cosine at the emitter is height / distance.
    const Vector by_area = hn::Div(hn::Mul(distance2, distance), hn::Mul(number(shape.area), s.height));
    return {scaled(to, hn::Div(number(1.0f), distance)), distance, same(shape.emission),
            hn::IfThenElse(s.near, hn::Div(number(1.0f), s.angle), by_area)};
}

HWY_INLINE LightLanes choose(LaneMask mask, const LightLanes& a, const LightLanes& b) {
    return {choose(mask, a.direction, b.direction), hn::IfThenElse(mask, a.distance, b.distance),
            choose(mask, a.radiance, b.radiance), hn::IfThenElse(mask, a.pdf, b.pdf)};
}

/// Weights of all shapes, one row of lanes each; returns their sum.
HWY_INLINE Vector weigh_shapes(const EmitterShape* shapes, int count, const Vec3& position, float* weights) {
    const Tag d;
    Vector sum = hn::Zero(d);
    for (int i = 0; i < count; ++i) {
        const Vector weight = hn::Mul(see_shape(shapes[i], position).angle, number(shapes[i].luminance));
        hn::Store(weight, d, weights + i * hn::MaxLanes(d));
        sum = hn::Add(sum, weight);
    }
    return sum;
}

/// Lanes of each shape's number, as a float; the last one of positive weight where rounding leaves none.
HWY_INLINE Vector choose_shape(const float* weights, int count, Vector left) {
    const Tag d;
    Vector chosen = hn::Zero(d);
    auto open = hn::Eq(chosen, chosen);
    for (int i = 0; i < count; ++i) {
        const Vector weight = hn::Load(d, weights + i * hn::MaxLanes(d));
        const auto candidate = hn::And(open, hn::Gt(weight, hn::Zero(d)));
        chosen = hn::IfThenElse(candidate, number(static_cast<float>(i)), chosen);
        open = hn::And(open, hn::Not(hn::And(candidate, hn::Lt(left, weight))));
        left = hn::Sub(left, weight);
    }
    return chosen;
}

/// Rounding can turn a direction at the rim of a shape seen edge-on past its plane: such lanes have density 0.
HWY_INLINE LightLanes with_valid_pdf(LightLanes light) {
    const Tag d;
    const Vector most = number(3e38f), zero = hn::Zero(d);
    const auto finite = hn::And(hn::Lt(light.pdf, most), hn::Lt(light.distance, most));
    const auto valid = hn::And(finite, hn::And(hn::Gt(light.pdf, zero), hn::Gt(light.distance, zero)));
    light.pdf = hn::IfThenElseZero(valid, light.pdf);
    return light;
}

HWY_INLINE LightLanes sample_shape_lanes(const EmitterShape* shapes, int count, const Vec3& position, Vector choice, Vector u,
                                         Vector v) {
    const Tag d;
    if (count == 1) {
        const SeenShape seen = see_shape(shapes[0], position);
        LightLanes light = sample_shape(shapes[0], seen, u, v);
        light.pdf = hn::IfThenElseZero(hn::Gt(seen.angle, hn::Zero(d)), light.pdf);
        return with_valid_pdf(light);
    }
    alignas(64) float weights[most_weighed * hn::MaxLanes(Tag())];
    const Vector sum = weigh_shapes(shapes, count, position, weights);
    const Vector chosen = choose_shape(weights, count, hn::Mul(choice, sum));
    const Vector zero = hn::Zero(d);
    LightLanes light{{zero, zero, zero}, zero, {zero, zero, zero}, zero};
    for (int i = 0; i < count; ++i) {
        const Vector weight = hn::Load(d, weights + i * hn::MaxLanes(d));
        const auto mine = hn::And(hn::Eq(chosen, number(static_cast<float>(i))), hn::Gt(weight, zero));
        if (hn::AllFalse(d, mine)) continue;
        LightLanes one = sample_shape(shapes[i], see_shape(shapes[i], position), u, v);
        one.pdf = hn::Mul(one.pdf, hn::Div(weight, sum));
        light = choose(mine, one, light);
    }
    return with_valid_pdf(light);
}

/// Density of sample_shape_lanes for points of one shape, by direction.
HWY_INLINE Vector shape_pdf_lanes(const EmitterShape* shapes, int count, const Vec3& position, const Vec3& direction, int which) {
    const Tag d;
    alignas(64) float weights[most_weighed * hn::MaxLanes(Tag())];
    const Vector sum = weigh_shapes(shapes, count, position, weights);
    const SeenShape seen = see_shape(shapes[which], position);
    const Vector cosine = hn::Neg(dot(direction, same(shapes[which].normal)));
    const Vector distance = hn::Div(seen.height, cosine);
    const Vector by_area = hn::Div(hn::Mul(distance, distance), hn::Mul(number(shapes[which].area), cosine));
    const Vector weight = hn::Load(d, weights + which * hn::MaxLanes(d));
    const Vector pdf = hn::Mul(hn::Div(weight, sum), hn::IfThenElse(seen.near, hn::Div(number(1.0f), seen.angle), by_area));
    const auto valid = hn::And(hn::Gt(weight, hn::Zero(d)), hn::Gt(cosine, hn::Zero(d)));
    return hn::IfThenElseZero(valid, pdf);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
