// Where vectors of cones are in a view volume, and in any domain that is not plain. Included once for every vector target.
#if defined(INTERREFLECT_VIEW_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_VIEW_LANES
#undef INTERREFLECT_VIEW_LANES
#else
#define INTERREFLECT_VIEW_LANES
#endif

#include "voxels/march/warp_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What both view volumes do: space outside of them is unknown, and lets everything through.
class ViewLanes {
  public:
    static constexpr bool nested = false, view_volume = true;
    explicit ViewLanes(const Domain& domain) : warp_(domain.warp), size_(domain.cells) {}

  protected:
    /// Distance from which on rays are beyond a bound for good, with something to spare.
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V beyond(D d, V distance) const {
        return hn::MulAdd(hn::Max(distance, hn::Zero(d)), hn::Set(d, 1.0001f), hn::Set(d, 0.01f));
    }
    /// Distance at which rays leave a half space for good. `height`: of their starts above its plane, positive outside; `rise`:
    /// of the height with distance.
    template <class D, class V = hn::Vec<D>>
    static HWY_INLINE V leaves(D d, V height, V rise) {
        const auto outwards = hn::Gt(rise, hn::Set(d, 1e-6f));
        const V distance = hn::Div(hn::Neg(height), hn::IfThenElse(outwards, rise, hn::Set(d, 1.0f)));
        return hn::IfThenElse(outwards, distance, hn::Set(d, 1e9f));
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE Lanes3<V> in_view(D d, const Lanes3<V>& v) const {
        return {dot(d, v, warp_.right), dot(d, v, warp_.up), dot(d, v, warp_.forward)};
    }
    /// `gradients` of the voxels' x, y and z, in the view's axes.
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE SurfaceLanes<V> surface_by(D d, const Lanes3<V>& voxels, const Lanes3<V>& normal,
                                          const Lanes3<V> (&gradients)[3]) const {
        const Lanes3<V> n = in_view(d, normal);
        const Lanes3<V> way{dot(gradients[0], n), dot(gradients[1], n), dot(gradients[2], n)};
        const Lanes3<V> across[3] = {cross(gradients[1], gradients[2]), cross(gradients[2], gradients[0]),
                                     cross(gradients[0], gradients[1])};
        const V volume = dot(gradients[0], across[0]);
        const auto of = [&](int axis) HWY_ATTR { return hn::Mul(hn::CopySign(hn::Set(d, 1.0f), volume), dot(across[axis], n)); };
        return {voxels, {of(0), of(1), of(2)}, hn::Sqrt(dot(way, way)), hn::Abs(volume)};
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE void finish(D d, V volume, LanesAt<D>& at) const {
        at.density = hn::Max(density_across(d, volume, at.stretch), hn::Set(d, 1e-20f));
        at.least_level = hn::Zero(d);
        const auto between = [&](V q, float size)
                                 HWY_ATTR { return hn::And(hn::Ge(q, hn::Zero(d)), hn::Le(q, hn::Set(d, size))); };
        at.inside = hn::And(at.inside, hn::And(between(at.voxels.x, size_.x),
                                               hn::And(between(at.voxels.y, size_.y), between(at.voxels.z, size_.z))));
        at.voxels = {within(d, at.voxels.x, size_.x), within(d, at.voxels.y, size_.y), within(d, at.voxels.z, size_.z)};
    }

    Warp warp_;
    vec3 size_;
};

class PerspectiveLanes : public ViewLanes {
  public:
    using ViewLanes::ViewLanes;
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V exit(D d, const Lanes3<V>& start, const Lanes3<V>& direction) const {
        const Lanes3<V> v = in_view(d, start), w = in_view(d, direction);
        const auto side = [&](V p, V along, float half) HWY_ATTR {
            const V k = hn::Set(d, half);
            return hn::Min(leaves(d, hn::NegMulAdd(k, v.z, p), hn::NegMulAdd(k, w.z, along)),
                           leaves(d, hn::NegMulAdd(k, v.z, hn::Neg(p)), hn::NegMulAdd(k, w.z, hn::Neg(along))));
        };
        const V front = leaves(d, hn::Sub(hn::Set(d, warp_.near), v.z), hn::Neg(w.z));
        const V back = leaves(d, hn::Sub(v.z, hn::Set(d, warp_.far)), w.z);
        return beyond(d, hn::Min(hn::Min(front, back), hn::Min(side(v.x, w.x, warp_.half_x), side(v.y, w.y, warp_.half_y))));
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE LanesAt<D> at(D d, const Lanes3<V>& start, const Lanes3<V>& direction, V distance) const {
        const Lanes3<V> v = in_view(d, along(d, start, direction, distance)), w = in_view(d, direction);
        const V near = hn::Set(d, warp_.near);
        const Place<V> p = place(d, v, hn::Max(v.z, near));
        LanesAt<D> at;
        at.inside = hn::Ge(v.z, near);
        at.voxels = p.voxels;
        set_way(d,
                Lanes3<V>{hn::Mul(p.dense.x, hn::NegMulAdd(p.x, w.z, w.x)), hn::Mul(p.dense.y, hn::NegMulAdd(p.y, w.z, w.y)),
                          hn::Mul(p.dense.z, w.z)},
                at);
        finish(d, hn::Mul(hn::Mul(p.dense.x, p.dense.y), p.dense.z), at);
        return at;
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE SurfaceLanes<V> surface(D d, const Lanes3<V>& at, const Lanes3<V>& normal) const {
        const Lanes3<V> v = in_view(d, at);
        const V zero = hn::Zero(d);
        const Place<V> p = place(d, v, v.z);
        return surface_by(d, p.voxels, normal,
                          {{p.dense.x, zero, hn::Neg(hn::Mul(p.dense.x, p.x))},
                           {zero, p.dense.y, hn::Neg(hn::Mul(p.dense.y, p.y))},
                           {zero, zero, p.dense.z}});
    }

  private:
    template <class V>
    struct Place {
        V x, y;                   // tangents
        Lanes3<V> voxels, dense;  // voxels along a linear one of the view's axes
    };
    /// depth: v.z, or what stands for it.
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE Place<V> place(D d, const Lanes3<V>& v, V depth) const {
        const V one = hn::Set(d, 1.0f), near = hn::Set(d, warp_.near), inverse = hn::Div(one, depth);
        const V kx = hn::Set(d, 0.5f * size_.x / warp_.half_x), ky = hn::Set(d, 0.5f * size_.y / warp_.half_y);
        const V even = hn::Set(d, size_.z / (warp_.far - warp_.near)), k = hn::Set(d, size_.z / (1.0f - warp_.near / warp_.far));
        Place<V> p;
        p.x = hn::Mul(v.x, inverse), p.y = hn::Mul(v.y, inverse);
        p.dense = {hn::Mul(kx, inverse), hn::Mul(ky, inverse),
                   warp_.linear_depth ? even : hn::Mul(hn::Mul(k, near), hn::Mul(inverse, inverse))};
        p.voxels = {hn::MulAdd(kx, p.x, hn::Set(d, 0.5f * size_.x)), hn::MulAdd(ky, p.y, hn::Set(d, 0.5f * size_.y)),
                    warp_.linear_depth ? hn::Mul(hn::Sub(v.z, near), even) : hn::Mul(k, hn::NegMulAdd(near, inverse, one))};
        return p;
    }
};

class SphericalLanes : public ViewLanes {
  public:
    explicit SphericalLanes(const Domain& domain)
        : ViewLanes(domain),
          octaves_(std::log2(warp_.far / warp_.near)),
          first_(std::log2(warp_.near)),
          scale_(0.5f * size_.x / warp_.half_x, 0.5f * size_.y / warp_.half_y, size_.z / (octaves_ * std::log(2.0f))) {}
    /// Of the outer sphere, both sides and the cones above and below.
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V exit(D d, const Lanes3<V>& start, const Lanes3<V>& direction) const {
        const Lanes3<V> v = in_view(d, start), w = in_view(d, direction);
        const V cosine = hn::Set(d, std::cos(warp_.half_x)), sine = hn::Set(d, std::sin(warp_.half_x));
        const auto side = [&](V p, V along) HWY_ATTR {
            return leaves(d, hn::NegMulAdd(sine, v.z, hn::Mul(cosine, p)), hn::NegMulAdd(sine, w.z, hn::Mul(cosine, along)));
        };
        const V far = hn::Set(d, warp_.far), towards = dot(v, w);
        const V inside = hn::MulAdd(far, far, hn::MulSub(towards, towards, dot(v, v)));
        const V outer = hn::Sub(hn::Sqrt(hn::Max(inside, hn::Zero(d))), towards);
        const V above = into_cone(d, v, w, 1.0f, warp_.elevation + warp_.half_y),
                below = into_cone(d, v, w, -1.0f, warp_.half_y - warp_.elevation);
        const V sides = hn::Min(side(v.x, w.x), side(hn::Neg(v.x), hn::Neg(w.x)));
        return beyond(d, hn::Min(hn::Min(outer, sides), hn::Min(above, below)));
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE LanesAt<D> at(D d, const Lanes3<V>& start, const Lanes3<V>& direction, V distance) const {
        const Lanes3<V> v = in_view(d, along(d, start, direction, distance)), w = in_view(d, direction);
        const Radii<V> r(d, v);
        LanesAt<D> at;
        at.inside = hn::Gt(v.z, hn::Zero(d));  // angles lie within 85 degrees of the volume's middle
        at.voxels = voxels(d, v, r, hn::Atan(d, hn::Div(v.x, hn::Max(v.z, hn::Set(d, 1e-12f)))));
        const V inverse2 = hn::Div(hn::Set(d, 1.0f), r.radius2), outwards = hn::MulAdd(v.x, w.x, hn::Mul(v.z, w.z));
        const V turn = hn::Div(hn::Sub(hn::Mul(v.z, w.x), hn::Mul(v.x, w.z)), r.across2);
        const V rise = hn::Mul(hn::Sub(hn::Mul(r.across, w.y), hn::Div(hn::Mul(v.y, outwards), r.across)), inverse2);
        const V away = hn::Mul(hn::MulAdd(v.y, w.y, outwards), inverse2);
        const V kx = hn::Set(d, scale_.x), ky = hn::Set(d, scale_.y), kz = hn::Set(d, scale_.z);
        set_way(d, Lanes3<V>{hn::Mul(kx, turn), hn::Mul(ky, rise), hn::Mul(kz, away)}, at);
        // The three gradients are perpendicular: 1 / across, 1 / radius, 1 / radius.
        finish(d, hn::Div(hn::Mul(hn::Mul(kx, ky), kz), hn::Mul(r.across, r.radius2)), at);
        return at;
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE SurfaceLanes<V> surface(D d, const Lanes3<V>& at, const Lanes3<V>& normal) const {
        const Lanes3<V> v = in_view(d, at);
        const Radii<V> r(d, v);
        const V zero = hn::Zero(d), behind = hn::IfThenElseZero(hn::Lt(v.z, zero), hn::Set(d, pi));
        const V azimuth = hn::Add(hn::Atan(d, hn::Div(v.x, v.z)), hn::CopySign(behind, v.x));
        const V inverse2 = hn::Div(hn::Set(d, 1.0f), r.radius2), turn = hn::Div(hn::Set(d, scale_.x), r.across2);
        const V rise = hn::Mul(hn::Set(d, scale_.y), inverse2), fall = hn::Neg(hn::Mul(rise, hn::Div(v.y, r.across)));
        const V away = hn::Mul(hn::Set(d, scale_.z), inverse2);
        return surface_by(d, voxels(d, v, r, azimuth), normal,
                          {{hn::Mul(turn, v.z), zero, hn::Neg(hn::Mul(turn, v.x))},
                           {hn::Mul(fall, v.x), hn::Mul(rise, r.across), hn::Mul(fall, v.z)},
                           {hn::Mul(away, v.x), hn::Mul(away, v.y), hn::Mul(away, v.z)}});
    }

  private:
    /// Distances from the view's upright axis and from the eye.
    template <class V>
    struct Radii {
        V across2, across, radius2;

        template <class D>
        HWY_INLINE Radii(D d, const Lanes3<V>& v)
            : across2(hn::Max(hn::MulAdd(v.x, v.x, hn::Mul(v.z, v.z)), hn::Set(d, 1e-12f))),
              across(hn::Sqrt(across2)),
              radius2(hn::MulAdd(v.y, v.y, across2)) {}
    };
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE Lanes3<V> voxels(D d, const Lanes3<V>& v, const Radii<V>& r, V azimuth) const {
        const V elevation = hn::Sub(hn::Atan(d, hn::Div(v.y, r.across)), hn::Set(d, warp_.elevation));
        const V level = hn::Sub(hn::Mul(hn::Set(d, 0.5f), log2_of(d, r.radius2)), hn::Set(d, first_));
        return {hn::MulAdd(hn::Set(d, scale_.x), azimuth, hn::Set(d, 0.5f * size_.x)),
                hn::MulAdd(hn::Set(d, scale_.y), elevation, hn::Set(d, 0.5f * size_.y)),
                hn::Mul(hn::Set(d, size_.z / octaves_), level)};
    }
    /// Distance from which on rays are in the cone of elevations above `elevation`, seen upside down where `sign` is -1; never
    /// where it is no convex one. A ray that goes its way is in it from the last crossing on.
    template <class D, class V = hn::Vec<D>>
    static HWY_INLINE V into_cone(D d, const Lanes3<V>& v, const Lanes3<V>& w, float sign, float elevation) {
        const V never = hn::Set(d, 1e9f);
        if (elevation <= 0.0f || elevation >= 0.5f * pi) return never;
        const float slope = std::tan(elevation);
        const V square = hn::Set(d, slope * slope);
        const auto form = [&](const Lanes3<V>& a, const Lanes3<V>& b) HWY_ATTR {
            return hn::NegMulAdd(square, hn::MulAdd(a.x, b.x, hn::Mul(a.z, b.z)), hn::Mul(a.y, b.y));
        };
        const V a = form(w, w), b = form(v, w), c = form(v, v), tiny = hn::Set(d, 1e-6f);
        const auto goes = hn::And(hn::Gt(a, tiny), hn::Gt(hn::Mul(w.y, hn::Set(d, sign)), hn::Zero(d)));
        const V root = hn::Sqrt(hn::Max(hn::MulSub(b, b, hn::Mul(a, c)), hn::Zero(d)));
        return hn::IfThenElse(goes, hn::Div(hn::Sub(root, b), hn::Max(a, tiny)), never);
    }

    float octaves_, first_;  // of depths; log2 of the nearest
    vec3 scale_;             // voxels a radian, and a natural logarithm of depth
};

/// Calls call(map) with the lanes of a domain that is not plain.
template <class Call>
HWY_INLINE auto with_lanes(const Domain& domain, const Call& call) {
    if (domain.cascades > 1) return call(NestedLanes(domain));
    switch (domain.warp.kind) {
        case Warp::Kind::perspective:
            return call(PerspectiveLanes(domain));
        case Warp::Kind::spherical:
            return call(SphericalLanes(domain));
        case Warp::Kind::logistic:
            return call(SeparableLanes<LogisticCurve>(domain));
        default:
            return call(SeparableLanes<CubicCurve>(domain));
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
