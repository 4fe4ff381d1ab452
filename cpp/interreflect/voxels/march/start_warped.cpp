#include "voxels/march/march_warped.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/march/start_warped.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxels/march/opacity-inl.h"
#include "voxels/march/view_lanes-inl.h"

// Roofline: as receivers.cpp, and some 60 operations more for the warp; spherical ones take two arc tangents.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// set_warped_start for a vector of receivers.
template <class Map, class D, class V = hn::Vec<D>>
HWY_INLINE void start_vector(D d, const Map& map, const Domain& domain, const Lanes3<V>& surface, const Lanes3<V>& normal,
                             float normal_offset, bool see_own_surface, int i, ConeBatch& batch) {
    const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const SurfaceLanes<V> on = map.surface(d, surface, normal);
    const V offset = hn::Div(hn::Set(d, normal_offset), on.stretch), unit = hn::Div(one, hn::Sqrt(dot(on.normal, on.normal)));
    const Lanes3<V> facing{hn::Mul(on.normal.x, unit), hn::Mul(on.normal.y, unit), hn::Mul(on.normal.z, unit)};
    const Lanes3<V> size{hn::Abs(facing.x), hn::Abs(facing.y), hn::Abs(facing.z)};
    const auto is_x = hn::And(hn::Ge(size.x, size.y), hn::Ge(size.x, size.z)), is_y = hn::Ge(size.y, size.z);
    const auto longest = [&](V x, V y, V z) HWY_ATTR { return hn::IfThenElse(is_x, x, hn::IfThenElse(is_y, y, z)); };
    const auto cells = [&](int axis)
                           HWY_ATTR { return hn::Set(d, static_cast<float>(domain.cells[axis] << (domain.cascades - 1))); };
    hn::Store(hn::MulAdd(normal.x, offset, surface.x), d, batch.x + i);
    hn::Store(hn::MulAdd(normal.y, offset, surface.y), d, batch.y + i);
    hn::Store(hn::MulAdd(normal.z, offset, surface.z), d, batch.z + i);
    hn::Store(exp2_of(d, hn::Mul(log2_of(d, on.volume), hn::Set(d, -1.0f / 3.0f))), d, batch.scale + i);
    hn::Store(facing.x, d, batch.nx + i);
    hn::Store(facing.y, d, batch.ny + i);
    hn::Store(facing.z, d, batch.nz + i);
    hn::Store(hn::Neg(dot(facing, on.voxels)), d, batch.height + i);
    hn::Store(see_own_surface ? zero : hn::Add(hn::Add(size.x, size.y), size.z), d, batch.width + i);
    hn::Store(longest(zero, one, hn::Add(one, one)), d, batch.axis + i);
    hn::Store(longest(on.voxels.x, on.voxels.y, on.voxels.z), d, batch.axis_plane + i);
    hn::Store(longest(cells(0), cells(1), cells(2)), d, batch.axis_cells + i);
    // View volumes bend planes: only separable warps leave one along an axis where it is.
    const V most = longest(size.x, size.y, size.z);
    const auto flat = hn::Gt(most, hn::Set(d, Map::view_volume ? 2.0f : aligned_cosine));
    hn::Store(hn::IfThenElseZero(flat, one), d, batch.aligned + i);
}

void start_by_kind(const Domain& domain, float normal_offset, bool see_own_surface, const Receivers& receivers,
                   ConeBatch& batch) {
    const hn::ScalableTag<float> d;
    using V = hn::Vec<decltype(d)>;
    const V scale = hn::Set(d, 1.0f / domain.voxel_size);
    with_lanes(domain, [&](const auto& map) HWY_ATTR {
        for (int i = 0; i < receivers.count; i += static_cast<int>(hn::Lanes(d))) {
            const auto linear = [&](int axis) HWY_ATTR {
                return hn::Mul(hn::Sub(hn::Load(d, receivers.position[axis] + i), hn::Set(d, domain.lower[axis])), scale);
            };
            const Lanes3<V> normal{hn::Load(d, receivers.facing[0] + i), hn::Load(d, receivers.facing[1] + i),
                                   hn::Load(d, receivers.facing[2] + i)};
            start_vector(d, map, domain, Lanes3<V>{linear(0), linear(1), linear(2)}, normal, normal_offset, see_own_surface, i,
                         batch);
        }
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(start_by_kind);

void start_warped(const Domain& domain, float normal_offset, bool see_own_surface, const Receivers& receivers, ConeBatch& batch) {
    batch.count = receivers.count;
    HWY_DYNAMIC_DISPATCH(start_by_kind)(domain, normal_offset, see_own_surface, receivers, batch);
}

void set_warped_start(ConeBatch& batch, int i, const Domain& domain, const vec3& surface, const vec3& normal, float offset,
                      bool see_own_surface) {
    vec3 facing, on_surface = surface;
    float stretch, volume;  // voxels along the normal, and voxels in a linear one
    if (domain.warp.view_volume()) {
        const mat3 density = domain.density(surface);
        on_surface = domain.place(surface).voxels;
        facing = glm::normalize(glm::transpose(glm::inverse(density)) * normal);
        stretch = glm::length(density * normal), volume = std::fabs(glm::determinant(density));
    } else {
        // Nested grids are marched in linear voxels of the finest one, by a coarseness without jumps.
        auto [voxels, slopes] = domain.warp.slopes_at(surface, domain.cells);
        if (domain.cascades > 1)
            slopes = vec3(std::exp2(-domain.grid_level(surface)));
        else
            on_surface = voxels;
        slopes = glm::max(slopes, vec3(1e-3f));  // as in the march
        facing = glm::normalize(normal / slopes);
        stretch = glm::length(slopes * normal), volume = slopes.x * slopes.y * slopes.z;
    }
    const vec3 start = surface + normal * (offset / stretch);
    batch.x[i] = start.x, batch.y[i] = start.y, batch.z[i] = start.z;
    batch.scale[i] = 1.0f / std::cbrt(volume);
    set_plane(batch, i, domain, on_surface, facing, see_own_surface);
    // View volumes bend planes: only separable warps leave one along an axis where it is.
    if (domain.warp.view_volume()) batch.aligned[i] = 0.0f;
}

}  // namespace interreflect
#endif
