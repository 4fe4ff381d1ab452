// Where vectors of cones are in a warped grid. Included once for every vector target.
#if defined(INTERREFLECT_WARP_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_WARP_LANES
#undef INTERREFLECT_WARP_LANES
#else
#define INTERREFLECT_WARP_LANES
#endif

#include <hwy/contrib/math/math-inl.h>

#include "data/domain.h"
#include "voxels/march/taps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Lanes3 {
    V x, y, z;
};
template <class V>
HWY_INLINE V dot(const Lanes3<V>& a, const Lanes3<V>& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
template <class V>
HWY_INLINE Lanes3<V> cross(const Lanes3<V>& a, const Lanes3<V>& b) {
    return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
            hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V dot(D d, const Lanes3<V>& a, const vec3& b) {
    return dot(a, Lanes3<V>{hn::Set(d, b.x), hn::Set(d, b.y), hn::Set(d, b.z)});
}

/// A sample of each cone of a vector, in a domain's voxels.
template <class D, class V = hn::Vec<D>>
struct LanesAt {
    Lanes3<V> voxels;  // place; of nested grids, in linear voxels of the finest one
    Lanes3<V> toward;  // unit direction there
    V stretch;         // voxels along a linear voxel of the way
    V density;         // voxels along a linear voxel across the way
    V least_level;     // finest level there is
    hn::Mask<D> inside;
};

/// Where cones start from.
template <class V>
struct SurfaceLanes {
    Lanes3<V> voxels;  // place, as LanesAt has it
    Lanes3<V> normal;  // of the surface as the warp bends it, of any length
    V stretch;         // voxels along a linear voxel of the normal
    V volume;          // voxels in a linear one
};
/// Where the warp leaves axes as they are; `slopes`: voxels along a linear one on each.
template <class V>
HWY_INLINE SurfaceLanes<V> surface_of(const Lanes3<V>& voxels, const Lanes3<V>& normal, const Lanes3<V>& slopes) {
    const Lanes3<V> steep{hn::Mul(normal.x, slopes.x), hn::Mul(normal.y, slopes.y), hn::Mul(normal.z, slopes.z)};
    const Lanes3<V> flat{hn::Div(normal.x, slopes.x), hn::Div(normal.y, slopes.y), hn::Div(normal.z, slopes.z)};
    return {voxels, flat, hn::Sqrt(dot(steep, steep)), hn::Mul(hn::Mul(slopes.x, slopes.y), slopes.z)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Lanes3<V> along(D, const Lanes3<V>& start, const Lanes3<V>& direction, V distance) {
    return {hn::MulAdd(direction.x, distance, start.x), hn::MulAdd(direction.y, distance, start.y),
            hn::MulAdd(direction.z, distance, start.z)};
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V within(D d, V p, float size) {
    return hn::Min(hn::Max(p, hn::Zero(d)), hn::Set(d, size));
}
/// Voxels along a linear voxel across the way, the mean of both directions: of `volume` voxels in a linear one.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V density_across(D d, V volume, V stretch) {
    return hn::Sqrt(hn::Div(volume, hn::Max(stretch, hn::Set(d, 1e-20f))));
}
/// Fills `toward` and `stretch` from voxels along each axis for a linear voxel of the way.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void set_way(D d, const Lanes3<V>& way, LanesAt<D>& at) {
    at.stretch = hn::Sqrt(dot(way, way));
    const V scale = hn::Div(hn::Set(d, 1.0f), hn::Max(at.stretch, hn::Set(d, 1e-20f)));
    at.toward = {hn::Mul(way.x, scale), hn::Mul(way.y, scale), hn::Mul(way.z, scale)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V box_exit(D d, const Lanes3<V>& start, const Lanes3<V>& direction, const vec3& size) {
    return hn::Min(hn::Min(exit_distance(d, start.x, direction.x, size.x), exit_distance(d, start.y, direction.y, size.y)),
                   exit_distance(d, start.z, direction.z, size.z));
}

/// data/warp.cpp's curves: value and slope at u in [0, 1].
struct CubicCurve {
    template <class D, class V = hn::Vec<D>>
    static HWY_INLINE void at(D d, float s, V u, V& value, V& slope) {
        const V square = hn::Mul(u, u), rest = hn::Set(d, 1.0f - s), steep = hn::Set(d, s);
        value = hn::Mul(u, hn::MulAdd(rest, square, steep));
        slope = hn::MulAdd(hn::Mul(rest, hn::Set(d, 3.0f)), square, steep);
    }
};
struct LogisticCurve {
    template <class D, class V = hn::Vec<D>>
    static HWY_INLINE void at(D d, float s, V u, V& value, V& slope) {
        const float whole = 1.0f / std::tanh(s);
        const V t = hn::Tanh(d, hn::Mul(u, hn::Set(d, s)));
        value = hn::Mul(t, hn::Set(d, whole));
        slope = hn::Mul(hn::NegMulAdd(t, t, hn::Set(d, 1.0f)), hn::Set(d, s * whole));
    }
};

/// Axis by axis about a centre. Beyond the box everything is as on its face, as in a plain grid.
template <class Curve>
class SeparableLanes {
  public:
    static constexpr bool nested = false, view_volume = false;
    explicit SeparableLanes(const Domain& domain) : size_(domain.cells), steepness_(domain.warp.steepness) {
        centre_ = domain.warp.centre;
        for (int axis = 0; axis < 3; ++axis) {
            below_[axis] = centre_[axis] > 0.0f ? 1.0f / centre_[axis] : 0.0f;
            const float above = size_[axis] - centre_[axis];
            above_[axis] = above > 0.0f ? 1.0f / above : 0.0f;
        }
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V exit(D d, const Lanes3<V>& start, const Lanes3<V>& direction) const {
        return box_exit(d, start, direction, size_);
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE LanesAt<D> at(D d, const Lanes3<V>& start, const Lanes3<V>& direction, V distance) const {
        LanesAt<D> at;
        Lanes3<V> s;
        at.voxels = place(d, along(d, start, direction, distance), s);
        set_way(d, Lanes3<V>{hn::Mul(direction.x, s.x), hn::Mul(direction.y, s.y), hn::Mul(direction.z, s.z)}, at);
        at.density = density_across(d, hn::Mul(hn::Mul(s.x, s.y), s.z), at.stretch);
        at.least_level = hn::Zero(d);
        at.inside = hn::Eq(distance, distance);
        return at;
    }

    template <class D, class V = hn::Vec<D>>
    HWY_INLINE SurfaceLanes<V> surface(D d, const Lanes3<V>& p, const Lanes3<V>& normal) const {
        Lanes3<V> slopes;
        const Lanes3<V> voxels = place(d, p, slopes);
        return surface_of(voxels, normal, slopes);
    }

  private:
    /// Voxels at p, and how many lie along a linear one on each axis.
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE Lanes3<V> place(D d, const Lanes3<V>& p, Lanes3<V>& slopes) const {
        return {curve(d, 0, p.x, slopes.x), curve(d, 1, p.y, slopes.y), curve(d, 2, p.z, slopes.z)};
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V curve(D d, int axis, V p, V& slope) const {
        const V centre = hn::Set(d, centre_[axis]);
        const V offset = hn::Sub(within(d, p, size_[axis]), centre), length = hn::Abs(offset);
        const V inverse = hn::IfThenElse(hn::Lt(offset, hn::Zero(d)), hn::Set(d, below_[axis]), hn::Set(d, above_[axis]));
        const V half = hn::IfThenElse(hn::Lt(offset, hn::Zero(d)), centre, hn::Sub(hn::Set(d, size_[axis]), centre));
        V value;
        Curve::at(d, steepness_, hn::Min(hn::Mul(length, inverse), hn::Set(d, 1.0f)), value, slope);
        slope = hn::Max(slope, hn::Set(d, 1e-3f));  // alpha = 0: a face's voxels are as long as the box
        return hn::Add(centre, hn::CopySign(hn::Mul(half, value), offset));
    }

    vec3 size_, centre_, below_, above_;
    float steepness_;
};

/// Nested grids: the voxels stay linear, but the finest level depends on the place.
class NestedLanes {
  public:
    static constexpr bool nested = true, view_volume = false;
    explicit NestedLanes(const Domain& domain)
        : size_(vec3(domain.cells) * static_cast<float>(1 << (domain.cascades - 1))), count_(domain.cascades - 1) {
        for (int k = 0; k < count_; ++k) {
            lower_[k] = domain.linear_in(k, vec3(0));
            upper_[k] = domain.linear_in(k, vec3(domain.cells));
            band_[k] = domain.band(k);
        }
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V exit(D d, const Lanes3<V>& start, const Lanes3<V>& direction) const {
        return box_exit(d, start, direction, size_);
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE LanesAt<D> at(D d, const Lanes3<V>& start, const Lanes3<V>& direction, V distance) const {
        const Lanes3<V> p = along(d, start, direction, distance);
        LanesAt<D> at;
        at.voxels = {within(d, p.x, size_.x), within(d, p.y, size_.y), within(d, p.z, size_.z)};
        at.toward = direction;
        at.stretch = at.density = hn::Set(d, 1.0f);
        at.inside = hn::Eq(distance, distance);
        at.least_level = grid_level(d, at.voxels);
        return at;
    }
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE SurfaceLanes<V> surface(D d, const Lanes3<V>& p, const Lanes3<V>& normal) const {
        const V slope = exp2_of(d, hn::Neg(grid_level(d, p)));
        return surface_of(p, normal, Lanes3<V>{slope, slope, slope});
    }

  private:
    /// Domain::grid_level.
    template <class D, class V = hn::Vec<D>>
    HWY_INLINE V grid_level(D d, const Lanes3<V>& p) const {
        const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
        V level = zero;
        for (int k = 0; k < count_; ++k) {
            const auto depth = [&](V q, int axis) HWY_ATTR {
                return hn::Min(hn::Sub(q, hn::Set(d, lower_[k][axis])), hn::Sub(hn::Set(d, upper_[k][axis]), q));
            };
            const V deep = hn::Min(hn::Min(depth(p.x, 0), depth(p.y, 1)), depth(p.z, 2));
            const V left = hn::Mul(hn::Sub(deep, hn::Set(d, band_[k].x)), hn::Set(d, band_[k].y));
            level = hn::Add(level, hn::Min(hn::Max(hn::Sub(one, left), zero), one));
        }
        return level;
    }

    vec3 size_, lower_[Domain::most_cascades], upper_[Domain::most_cascades];
    vec2 band_[Domain::most_cascades];
    int count_;
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
