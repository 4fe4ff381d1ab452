// Numbers of a packet's triangles, interpolated lane by lane: for hits that share none. Included once for every vector target.
#if defined(INTERREFLECT_INTERPOLATE_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_INTERPOLATE_KERNEL
#undef INTERREFLECT_INTERPOLATE_KERNEL
#else
#define INTERREFLECT_INTERPOLATE_KERNEL
#endif

#include <hwy/cache_control.h>

#include "visibility/packet_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Four values a lane, side by side, as they come from the vertices.
using Quads = float[packet][4];

/// Position and normal x; normal y, z and texture coordinates. Differences of the second and third corner to the first in the
/// same order. Largest magnitudes of the corners' coordinates.
struct Interpolated {
    alignas(64) Quads position_normal, normal_texcoord, edge1, edge2, largest;
    std::uint32_t material[packet];
};

/// Lanes that vectors may shade: a hit on what stands in world space, with a plain material.
HWY_INLINE std::uint32_t plain_lanes(const Geometry& geometry, const KernelMaterial* materials, const RayPacket& hits,
                                     std::uint32_t active) {
    std::uint32_t plain = 0;
    for (int k = 0; k < packet; ++k) {
        if (((active >> k) & 1U) == 0 || !hits.met(k) || !geometry.instances[hits.instance[k]].identity) continue;
        plain |= static_cast<std::uint32_t>(materials[geometry.arrays->materials[hits.triangle[k]]].plain) << k;
    }
    return plain;
}

HWY_INLINE void prefetch_triangles(const GeometryArrays& arrays, const RayPacket& hits) {
    for (int k = 0; k < packet; ++k) {
        if (!hits.met(k)) continue;
        hwy::Prefetch(arrays.triangles.data() + hits.triangle[k]);
        hwy::Prefetch(arrays.materials.data() + hits.triangle[k]);
    }
}

HWY_INLINE void prefetch_vertices(const GeometryArrays& arrays, const RayPacket& hits, std::uint32_t plain) {
    const auto* triangles = reinterpret_cast<const std::uint32_t*>(arrays.triangles.data());
    for (int k = 0; k < packet; ++k) {
        if (((plain >> k) & 1U) == 0) continue;
        const std::uint32_t* corners = triangles + 3 * std::size_t{hits.triangle[k]};
        for (int c = 0; c < 3; ++c) hwy::Prefetch(arrays.vertices.data() + corners[c]);
    }
}

/// Everything that is interpolated, lane by lane, eight numbers of a vertex at a time.
HWY_INLINE void interpolate(const GeometryArrays& arrays, const RayPacket& hits, std::uint32_t plain, Interpolated& s) {
    const hn::CappedTag<float, 4> d;
    const std::uint32_t* triangles = reinterpret_cast<const std::uint32_t*>(arrays.triangles.data());
    const float* vertices = reinterpret_cast<const float*>(arrays.vertices.data());
    // Lanes that are left out borrow the triangle of one that is not.
    const std::uint32_t stand_in = hits.triangle[hwy::Num0BitsBelowLS1Bit_Nonzero32(plain)];
    for (int k = 0; k < packet; ++k) {
        const bool taken = ((plain >> k) & 1U) != 0;
        const std::size_t triangle = taken ? hits.triangle[k] : stand_in;
        const auto u = hn::Set(d, taken ? hits.u[k] : 0.0f), v = hn::Set(d, taken ? hits.v[k] : 0.0f);
        const auto w = hn::Sub(hn::Sub(hn::Set(d, 1.0f), u), v);
        const std::uint32_t* corners = triangles + 3 * triangle;
        const float *a = vertices + 8 * std::size_t{corners[0]}, *b = vertices + 8 * std::size_t{corners[1]},
                    *c = vertices + 8 * std::size_t{corners[2]};
        const auto a0 = hn::Load(d, a), b0 = hn::Load(d, b), c0 = hn::Load(d, c);
        const auto a1 = hn::Load(d, a + 4), b1 = hn::Load(d, b + 4), c1 = hn::Load(d, c + 4);
        hn::Store(hn::Add(hn::Add(hn::Mul(a0, w), hn::Mul(b0, u)), hn::Mul(c0, v)), d, s.position_normal[k]);
        hn::Store(hn::Add(hn::Add(hn::Mul(a1, w), hn::Mul(b1, u)), hn::Mul(c1, v)), d, s.normal_texcoord[k]);
        hn::Store(hn::Sub(b0, a0), d, s.edge1[k]);
        hn::Store(hn::Sub(c0, a0), d, s.edge2[k]);
        hn::Store(hn::Max(hn::Abs(a0), hn::Max(hn::Abs(b0), hn::Abs(c0))), d, s.largest[k]);
        s.material[k] = arrays.materials[triangle];
    }
}

/// visible_normal of surface.h; `shading` need not be unit, and is zero where the mesh is flat.
HWY_INLINE Vec3 visible_normal_lanes(const Vec3& shading, const Vec3& geometric, const Vec3& direction) {
    const Tag d;
    const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Vector squared = dot(shading, shading);
    const auto smooth = hn::Gt(squared, zero);
    const Vector scale = hn::Div(one, hn::Sqrt(hn::IfThenElse(smooth, squared, one)));
    Vec3 normal = choose(smooth, scaled(shading, scale), geometric);
    normal = choose(hn::Lt(dot(normal, geometric), zero), negated(normal), normal);
    const Vector cosine = hn::Neg(dot(normal, direction));
    const auto hidden = hn::Le(cosine, zero);
    if (hn::AllFalse(d, hidden)) return normal;
    const Vector least = hn::Max(hn::Neg(dot(geometric, direction)), hn::Set(d, 1e-6f));
    const Vector share = hn::Sub(hn::Mul(hn::Set(d, 0x1p-6f), least), cosine);
    const Vec3 bent = moved(scaled(geometric, share), normal, least);
    return choose(hidden, scaled(bent, hn::Div(one, hn::Sqrt(dot(bent, bent)))), normal);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
