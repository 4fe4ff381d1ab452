#include "voxels/voxelize/triangle_packet.h"

#include "visibility/surface.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/voxelize/triangle_packet.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "voxels/voxelize/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

using IntTag = hn::RebindToSigned<Tag>;
using IntVector = hn::Vec<IntTag>;

HWY_INLINE Vec3 placed_by(const mat4x3& m, const Vec3& p) {
    const Tag d;
    const auto row = [&](int i) HWY_ATTR {
        const Vector turned = hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0][i]), p.x), hn::Mul(hn::Set(d, m[1][i]), p.y)),
                                      hn::Mul(hn::Set(d, m[2][i]), p.z));
        return hn::Add(turned, hn::Set(d, m[3][i]));
    };
    return {row(0), row(1), row(2)};
}

/// World space.
HWY_INLINE Vec3 load_corner(const PacketSource& s, IntVector vertex) {
    const Tag d;
    const IntVector at = hn::Add(hn::Add(vertex, vertex), vertex);
    const Vec3 p{hn::GatherIndex(d, s.positions, at), hn::GatherIndex(d, s.positions + 1, at),
                 hn::GatherIndex(d, s.positions + 2, at)};
    return s.placed == nullptr ? p : placed_by(*s.placed, p);
}

HWY_INLINE Vec3 to_linear(const PacketSource& s, const Vec3& p) {
    const Tag d;
    const Vector scale = hn::Set(d, s.voxels);
    return {hn::Mul(hn::Sub(p.x, hn::Set(d, s.lower.x)), scale), hn::Mul(hn::Sub(p.y, hn::Set(d, s.lower.y)), scale),
            hn::Mul(hn::Sub(p.z, hn::Set(d, s.lower.z)), scale)};
}

HWY_INLINE Vector largest_of(const Vec3& p) { return hn::Max(hn::Max(hn::Abs(p.x), hn::Abs(p.y)), hn::Abs(p.z)); }

HWY_INLINE void store_axes(const Vec3& v, TrianglePacket::Lanes* to, int k) {
    const Tag d;
    hn::Store(v.x, d, to[0] + k);
    hn::Store(v.y, d, to[1] + k);
    hn::Store(v.z, d, to[2] + k);
}

/// Whether any coordinate of `a` is less than that of `b`.
HWY_INLINE LaneMask any_less(const Vec3& a, const Vec3& b) {
    return hn::Or(hn::Or(hn::Lt(a.x, b.x), hn::Lt(a.y, b.y)), hn::Lt(a.z, b.z));
}

void load_lanes(const PacketSource& s, std::uint32_t first, std::uint32_t count, TrianglePacket& packet) {
    const Tag d;
    const IntTag di;
    const Vec3 zero{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const Vec3 cells{hn::Set(d, s.cells.x), hn::Set(d, s.cells.y), hn::Set(d, s.cells.z)};
    packet.first = first;
    packet.flips = s.flips;
    packet.with_area = packet.outside = packet.crossing = 0;
    for (int k = 0; k < TrianglePacket::width; k += static_cast<int>(hn::Lanes(d))) {
        // Those that are not there repeat the last one.
        const IntVector lane = hn::Min(hn::Iota(di, k), hn::Set(di, static_cast<std::int32_t>(count) - 1));
        const IntVector triangle = hn::Add(lane, hn::Set(di, static_cast<std::int32_t>(first)));
        const IntVector index = hn::Add(hn::Add(triangle, triangle), triangle);
        Vec3 corner[3];
        Vector largest = hn::Zero(d);
        for (int i = 0; i < 3; ++i) {
            const auto* numbers = reinterpret_cast<const std::int32_t*>(s.triangles) + i;
            const IntVector vertex = hn::GatherIndex(di, numbers, index);
            hn::Store(vertex, di, packet.vertex[i] + k);
            const Vec3 world = load_corner(s, vertex);
            largest = hn::Max(largest, largest_of(world));
            corner[i] = to_linear(s, world);
            store_axes(corner[i], packet.corner[i], k);
        }
        const Vec3 normal = rounded_cross(difference(corner[1], corner[0]), difference(corner[2], corner[0]));
        store_axes(normal, packet.cross, k);
        hn::Store(hn::Mul(largest, hn::Set(d, self_hit_share)), d, packet.offset + k);
        const Vector square =
            hn::Add(hn::Add(hn::Mul(normal.x, normal.x), hn::Mul(normal.y, normal.y)), hn::Mul(normal.z, normal.z));
        const LaneMask there = hn::RebindMask(d, hn::Lt(hn::Iota(di, k), hn::Set(di, static_cast<std::int32_t>(count))));
        packet.with_area |= bits_of(hn::And(there, hn::Gt(square, hn::Zero(d)))) << k;
        const Vec3 lower = lowest(corner), upper = highest(corner);
        packet.outside |= bits_of(hn::Or(any_less(upper, zero), any_less(cells, lower))) << k;
        packet.crossing |= bits_of(hn::Or(any_less(lower, zero), any_less(cells, upper))) << k;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(load_lanes);

PacketSource::PacketSource(const Geometry& geometry, const Domain& domain, std::uint32_t instance)
    : triangles(reinterpret_cast<const std::uint32_t*>(geometry.arrays->triangles.data())),
      positions(reinterpret_cast<const float*>(geometry.arrays->positions.data())),
      placed(geometry.instances[instance].identity ? nullptr : &geometry.instances[instance].world_from_local),
      lower(domain.lower),
      cells(domain.cells),
      voxels(1.0f / domain.voxel_size),
      flips(geometry.instances[instance].flips) {}

void load_packet(const PacketSource& source, std::uint32_t first, std::uint32_t count, TrianglePacket& packet) {
    HWY_DYNAMIC_DISPATCH(load_lanes)(source, first, count, packet);
}
}  // namespace interreflect
#endif
