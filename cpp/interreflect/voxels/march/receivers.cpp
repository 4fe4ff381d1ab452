#include "voxels/march/receivers.h"

#include "voxels/march/march_warped.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/march/receivers.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "math/lanes-inl.h"

// Roofline. 36 bytes of the G-buffer a pixel and about 60 operations, sixteen at a time: reading bounds it.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Column = float[Receivers::capacity];

HWY_INLINE Vec3 load_rows(const Column* rows, int i) {
    const Tag d;
    return {hn::Load(d, rows[0] + i), hn::Load(d, rows[1] + i), hn::Load(d, rows[2] + i)};
}

/// Not fused: the same bits as glm's.
HWY_INLINE Vector plain_dot(const Vec3& a, const Vec3& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Vector to_voxels(Vector position, float lower, float scale) {
    const Tag d;
    return hn::Mul(hn::Sub(position, hn::Set(d, lower)), hn::Set(d, scale));
}

/// longest_axis of march_cones.h.
struct LongestAxis {
    LaneMask is_x, is_y;

    HWY_INLINE explicit LongestAxis(const Vec3& size)
        : is_x(hn::And(hn::Ge(size.x, size.y), hn::Ge(size.x, size.z))), is_y(hn::Ge(size.y, size.z)) {}
    HWY_INLINE Vector of(const Vec3& v) const { return hn::IfThenElse(is_x, v.x, hn::IfThenElse(is_y, v.y, v.z)); }
};

/// Tangent, bitangent and normal, as Frame has them.
HWY_INLINE void frame_axes(const Vec3& n, Vec3 axes[3]) {
    const Tag d;
    const Vector one = hn::Set(d, 1.0f), sign = hn::CopySign(one, n.z);
    const Vector a = hn::Div(hn::Set(d, -1.0f), hn::Add(sign, n.z)), b = hn::Mul(hn::Mul(n.x, n.y), a);
    axes[0] = {hn::Add(one, hn::Mul(hn::Mul(hn::Mul(sign, n.x), n.x), a)), hn::Mul(sign, b), hn::Mul(hn::Neg(sign), n.x)};
    axes[1] = {b, hn::Add(sign, hn::Mul(hn::Mul(n.y, n.y), a)), hn::Neg(n.y)};
    axes[2] = n;
}

HWY_INLINE void store_axes(int i, Receivers& receivers) {
    const Tag d;
    Vec3 axes[3];
    frame_axes(load_rows(receivers.normal, i), axes);
    for (int a = 0; a < 3; ++a) {
        hn::Store(axes[a].x, d, receivers.per_axis[0][a] + i);
        hn::Store(axes[a].y, d, receivers.per_axis[1][a] + i);
        hn::Store(axes[a].z, d, receivers.per_axis[2][a] + i);
    }
}

/// As set_start.
HWY_INLINE void store_start(const Domain& domain, float normal_offset, bool see_own_surface, const Vec3& surface,
                            const Vec3& facing, int i, ConeBatch& batch) {
    const Tag d;
    const Vector offset = hn::Set(d, normal_offset), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const Vec3 size{hn::Abs(facing.x), hn::Abs(facing.y), hn::Abs(facing.z)};
    const LongestAxis longest(size);
    const Vec3 cells{hn::Set(d, static_cast<float>(domain.cells.x)), hn::Set(d, static_cast<float>(domain.cells.y)),
                     hn::Set(d, static_cast<float>(domain.cells.z))};
    hn::Store(hn::Add(surface.x, hn::Mul(facing.x, offset)), d, batch.x + i);
    hn::Store(hn::Add(surface.y, hn::Mul(facing.y, offset)), d, batch.y + i);
    hn::Store(hn::Add(surface.z, hn::Mul(facing.z, offset)), d, batch.z + i);
    hn::Store(facing.x, d, batch.nx + i);
    hn::Store(facing.y, d, batch.ny + i);
    hn::Store(facing.z, d, batch.nz + i);
    hn::Store(hn::Neg(plain_dot(facing, surface)), d, batch.height + i);
    hn::Store(see_own_surface ? zero : hn::Add(hn::Add(size.x, size.y), size.z), d, batch.width + i);
    hn::Store(longest.of({zero, one, hn::Add(one, one)}), d, batch.axis + i);
    hn::Store(longest.of(surface), d, batch.axis_plane + i);
    hn::Store(longest.of(cells), d, batch.axis_cells + i);
    hn::Store(hn::IfThenElseZero(hn::Gt(longest.of(size), hn::Set(d, aligned_cosine)), one), d, batch.aligned + i);
}

/// The last vector may reach beyond `count`: its other lanes are never read.
void start_lanes(const Domain& domain, float normal_offset, bool see_own_surface, Receivers& receivers, ConeBatch& batch) {
    const Tag d;
    const float scale = 1.0f / domain.voxel_size;
    batch.count = receivers.count;
    for (int i = 0; i < receivers.count; i += static_cast<int>(hn::Lanes(d))) {
        const Vec3 position = load_rows(receivers.position, i), facing = load_rows(receivers.facing, i);
        const Vec3 surface{to_voxels(position.x, domain.lower.x, scale), to_voxels(position.y, domain.lower.y, scale),
                           to_voxels(position.z, domain.lower.z, scale)};
        store_axes(i, receivers);
        store_start(domain, normal_offset, see_own_surface, surface, facing, i, batch);
        for (auto& row : receivers.sum) hn::Store(hn::Zero(d), d, row + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(start_lanes);

void start_receivers(const Domain& domain, float normal_offset, bool see_own_surface, Receivers& receivers, ConeBatch& batch) {
    HWY_DYNAMIC_DISPATCH(start_lanes)(domain, normal_offset, see_own_surface, receivers, batch);
    if (!domain.plain()) start_warped(domain, normal_offset, see_own_surface, receivers, batch);
}

}  // namespace interreflect
#endif
