// What vectors of cones see, in plain and in warped voxels alike. Included once for every vector target.
#if defined(INTERREFLECT_SEEN_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_SEEN_LANES
#undef INTERREFLECT_SEEN_LANES
#else
#define INTERREFLECT_SEEN_LANES
#endif

#include "voxels/march/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The planes of the receivers (ConeBatch).
template <class V>
struct PlaneLanes {
    V nx, ny, nz, height, width, axis, axis_plane, axis_cells, aligned;

    template <class D>
    HWY_INLINE PlaneLanes(D d, const ConeBatch& batch, int first)
        : nx(hn::Load(d, batch.nx + first)),
          ny(hn::Load(d, batch.ny + first)),
          nz(hn::Load(d, batch.nz + first)),
          height(hn::Load(d, batch.height + first)),
          width(hn::Load(d, batch.width + first)),
          axis(hn::Load(d, batch.axis + first)),
          axis_plane(hn::Load(d, batch.axis_plane + first)),
          axis_cells(hn::Load(d, batch.axis_cells + first)),
          aligned(hn::Load(d, batch.aligned + first)) {}

    /// What is left of an opacity seen at x, y, z without the plane's part of it. `fine`, and with weight `blend` `coarse` where
    /// there are `two` levels: texels a voxel.
    template <class D>
    HWY_INLINE V without(D d, V opacity, V x, V y, V z, V fine, V coarse, V blend, bool two) const {
        const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const V h = hn::MulAdd(x, nx, hn::MulAdd(y, ny, hn::MulAdd(z, nz, height))), along = of_axis(d, axis, x, y, z);
        V own = own_opacity(d, fine, h, width, axis_plane, along, axis_cells, aligned);
        if (two) {
            const V next = own_opacity(d, coarse, h, width, axis_plane, along, axis_cells, aligned);
            own = hn::MulAdd(hn::Sub(next, own), blend, own);
        }
        own = hn::IfThenElseZero(hn::Gt(width, zero), own);
        const V others = hn::Div(hn::Max(hn::Sub(opacity, own), zero), hn::Max(hn::Sub(one, own), hn::Set(d, 1e-3f)));
        return hn::Min(others, one);
    }
};

/// What cones have seen so far.
template <class V>
struct SeenLanes {
    V r, g, b, open, depth;  // depth: sum of the distances, each weighted by what was blocked there

    template <class D>
    HWY_INLINE explicit SeenLanes(D d)
        : r(hn::Zero(d)), g(hn::Zero(d)), b(hn::Zero(d)), open(hn::Set(d, 1.0f)), depth(hn::Zero(d)) {}

    /// A step at `distance` that newly blocks `blocked`, of texels with that opacity. Their radiance is premultiplied by it: the
    /// step shows more or less of it.
    template <class D>
    HWY_INLINE void add(D d, V texel_r, V texel_g, V texel_b, V opacity, V blocked, V distance, bool merged) {
        const V share = hn::Div(blocked, hn::Max(opacity, hn::Set(d, 1e-6f)));
        r = hn::MulAdd(share, texel_r, r);
        g = hn::MulAdd(share, texel_g, g);
        b = hn::MulAdd(share, texel_b, b);
        if (merged) depth = hn::MulAdd(blocked, distance, depth);
        open = hn::Sub(open, blocked);
    }
    /// Of cones of which less than `cut_off` is open, that counts as if it looked like what came before.
    template <class D>
    HWY_INLINE void store(D d, float cut_off, int first, ConeBatch& batch) const {
        if (batch.merged) hn::Store(mean_depth(d, depth, open), d, batch.depth + first);
        const V one = hn::Set(d, 1.0f);
        const auto closed = hn::Lt(open, hn::Set(d, cut_off));
        const V whole = hn::IfThenElse(closed, hn::Div(one, hn::Sub(one, open)), one);
        hn::Store(hn::Mul(r, whole), d, batch.r + first);
        hn::Store(hn::Mul(g, whole), d, batch.g + first);
        hn::Store(hn::Mul(b, whole), d, batch.b + first);
        hn::Store(hn::IfThenElse(closed, hn::Zero(d), open), d, batch.open + first);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
