// The surfaces of one packet. Included once for every vector target.
#if defined(INTERREFLECT_SURFACE_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_SURFACE_KERNEL
#undef INTERREFLECT_SURFACE_KERNEL
#else
#define INTERREFLECT_SURFACE_KERNEL
#endif

#include "visibility/interpolate_kernel-inl.h"
#include "visibility/texture_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Signed = hn::RebindToSigned<Tag>;
using SignedLanes = std::int32_t[packet];

/// What a packet's materials say, and its texture coordinates.
struct Painted {
    alignas(64) FloatLanes albedo[3], two_sided, u, v;
    alignas(64) SignedLanes width, height;
    alignas(64) SignedLanes texel[4];
};

/// Materials without a texture have a white one of one texel. Returns whether any lane has another.
HWY_INLINE bool look_up_paint(const KernelMaterial* materials, const Interpolated& at, Painted& paint, SurfacePacket& out) {
    bool textured = false;
    for (int k = 0; k < packet; ++k) {
        const KernelMaterial& m = materials[at.material[k]];
        for (int c = 0; c < 3; ++c) paint.albedo[c][k] = m.albedo[c];
        paint.two_sided[k] = m.two_sided ? 1.0f : 0.0f;
        out.material[k] = at.material[k];
        out.lobe[k] =
            m.specular[0] > 0.0f || m.specular[1] > 0.0f || m.specular[2] > 0.0f ? at.material[k] : SurfacePacket::no_lobe;
        const bool has_map = m.texels != nullptr;
        paint.width[k] = has_map ? m.levels[0].width : 1;
        paint.height[k] = has_map ? m.levels[0].height : 1;
        textured |= has_map;
    }
    return textured;
}

HWY_INLINE void store_rows(const Vec3& a, SurfacePacket::Lanes* rows, int k) {
    const Tag d;
    hn::Store(a.x, d, rows[0] + k);
    hn::Store(a.y, d, rows[1] + k);
    hn::Store(a.z, d, rows[2] + k);
}

HWY_INLINE void place_lanes(const RayPacket& hits, const Interpolated& at, int k, Painted& paint, SurfacePacket& out) {
    const Tag d;
    Vec3 position, shading, e1, e2, largest;
    Vector u, v, unused;
    hn::LoadInterleaved4(d, at.position_normal[k], position.x, position.y, position.z, shading.x);
    hn::LoadInterleaved4(d, at.normal_texcoord[k], shading.y, shading.z, u, v);
    hn::LoadInterleaved4(d, at.edge1[k], e1.x, e1.y, e1.z, unused);
    hn::LoadInterleaved4(d, at.edge2[k], e2.x, e2.y, e2.z, unused);
    hn::LoadInterleaved4(d, at.largest[k], largest.x, largest.y, largest.z, unused);
    const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    const Vec3 direction{hn::Load(d, hits.direction_x + k), hn::Load(d, hits.direction_y + k), hn::Load(d, hits.direction_z + k)};
    const Vec3 plane = cross(e1, e2);
    const auto front = hn::Lt(dot(plane, direction), zero);
    const Vec3 upward = scaled(plane, hn::Div(one, hn::Sqrt(dot(plane, plane))));
    const Vec3 geometric = choose(front, upward, negated(upward));
    const Vector reflects = hn::IfThenElse(front, one, hn::Load(d, paint.two_sided + k));
    store_rows(position, out.position, k);
    store_rows(geometric, out.geometric_normal, k);
    store_rows(visible_normal_lanes(shading, geometric, direction), out.normal, k);
    store_rows({hn::Mul(hn::Load(d, paint.albedo[0] + k), reflects), hn::Mul(hn::Load(d, paint.albedo[1] + k), reflects),
                hn::Mul(hn::Load(d, paint.albedo[2] + k), reflects)},
               out.albedo, k);
    hn::Store(hn::Mul(hn::Set(d, 0x1p-18f), hn::Max(largest.x, hn::Max(largest.y, largest.z))), d, out.offset + k);
    hn::Store(u, d, paint.u + k);
    hn::Store(v, d, paint.v + k);
    const hn::RebindToUnsigned<Tag> du;
    const auto lobe = hn::Load(du, out.lobe + k);
    const auto dark = hn::RebindMask(du, hn::Eq(reflects, zero));
    hn::Store(hn::IfThenElse(dark, hn::Set(du, SurfacePacket::no_lobe), lobe), du, out.lobe + k);
}

/// Numbers of the four texels within the finest level, and the weights of a bilinear look-up.
HWY_INLINE void place_taps(int k, Painted& paint, SurfacePacket& out) {
    const Tag d;
    const Signed di;
    const auto width = hn::Load(di, paint.width + k), height = hn::Load(di, paint.height + k);
    const Vector half = hn::Set(d, 0.5f);
    const Vector x = hn::Sub(hn::Mul(wrap_lanes(d, hn::Load(d, paint.u + k)), hn::ConvertTo(d, width)), half);
    const Vector y = hn::Sub(hn::Mul(wrap_lanes(d, hn::Load(d, paint.v + k)), hn::ConvertTo(d, height)), half);
    const Vector fx = hn::Floor(x), fy = hn::Floor(y);
    hn::Store(hn::Sub(x, fx), d, out.across + k);
    hn::Store(hn::Sub(y, fy), d, out.up + k);
    const auto one = hn::Set(di, 1), zero = hn::Zero(di);
    auto x0 = hn::ConvertTo(di, fx), y0 = hn::ConvertTo(di, fy);
    auto x1 = hn::Add(x0, one), y1 = hn::Add(y0, one);
    x0 = hn::IfThenElse(hn::Lt(x0, zero), hn::Add(x0, width), x0);
    y0 = hn::IfThenElse(hn::Lt(y0, zero), hn::Add(y0, height), y0);
    x1 = hn::IfThenElse(hn::Lt(x1, width), x1, hn::Sub(x1, width));
    y1 = hn::IfThenElse(hn::Lt(y1, height), y1, hn::Sub(y1, height));
    const auto row0 = hn::Mul(y0, width), row1 = hn::Mul(y1, width);
    hn::Store(hn::Add(row0, x0), di, paint.texel[0] + k);
    hn::Store(hn::Add(row0, x1), di, paint.texel[1] + k);
    hn::Store(hn::Add(row1, x0), di, paint.texel[2] + k);
    hn::Store(hn::Add(row1, x1), di, paint.texel[3] + k);
}

/// Leaves the numbers of the texels where texture_packet finds them.
HWY_INLINE void ask_for_taps(const KernelMaterial* materials, const Painted& paint, SurfacePacket& out) {
    for (int k = 0; k < packet; ++k) {
        for (int t = 0; t < 4; ++t) out.texel[t][k] = static_cast<std::uint32_t>(paint.texel[t][k]);
        const std::uint32_t* texels = materials[out.material[k]].texels;
        if (texels == nullptr) continue;
        hwy::Prefetch(texels + paint.texel[0][k]);
        hwy::Prefetch(texels + paint.texel[2][k]);
    }
}

std::uint32_t plain_packet(const SurfaceKernel& kernel, const RayPacket& hits, std::uint32_t active) {
    const std::uint32_t plain = plain_lanes(*kernel.geometry, kernel.materials.data(), hits, active);
    prefetch_vertices(*kernel.geometry->arrays, hits, plain);
    return plain;
}

void place_packet(const SurfaceKernel& kernel, const RayPacket& hits, std::uint32_t plain, SurfacePacket& out) {
    Interpolated at;
    Painted paint;
    interpolate(*kernel.geometry->arrays, hits, plain, at);
    const bool textured = look_up_paint(kernel.materials.data(), at, paint, out);
    constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
    for (int k = 0; k < packet; k += lanes) place_lanes(hits, at, k, paint, out);
    if (!textured) return;
    for (int k = 0; k < packet; k += lanes) place_taps(k, paint, out);
    ask_for_taps(kernel.materials.data(), paint, out);
}

HWY_INLINE Vector decode_channel(const float* linear, hn::Vec<Signed> texel, int shift) {
    const Signed di;
    return hn::GatherIndex(Tag(), linear, hn::And(hn::ShiftRightSame(texel, shift), hn::Set(di, 255)));
}

void texture_packet(const SurfaceKernel& kernel, std::uint32_t plain, const float* linear, SurfacePacket& out) {
    alignas(64) SignedLanes texel[4];
    bool textured = false;
    for (int k = 0; k < packet; ++k) {
        const std::uint32_t* texels = kernel.materials[out.material[k]].texels;
        const bool has_map = texels != nullptr && ((plain >> k) & 1U) != 0;
        textured |= has_map;
        for (int t = 0; t < 4; ++t) texel[t][k] = has_map ? static_cast<std::int32_t>(texels[out.texel[t][k]]) : -1;  // white
    }
    if (!textured) return;
    const Tag d;
    const Signed di;
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        const Vector across = hn::Load(d, out.across + k), up = hn::Load(d, out.up + k);
        for (int c = 0; c < 3; ++c) {
            const auto tap = [&](int t) HWY_ATTR { return decode_channel(linear, hn::Load(di, texel[t] + k), 8 * c); };
            const Vector low_left = tap(0), low = hn::MulAdd(hn::Sub(tap(1), low_left), across, low_left);
            const Vector high_left = tap(2), high = hn::MulAdd(hn::Sub(tap(3), high_left), across, high_left);
            const Vector value = hn::MulAdd(hn::Sub(high, low), up, low);
            hn::Store(hn::Mul(value, hn::Load(d, out.albedo[c] + k)), d, out.albedo[c] + k);
        }
    }
}

void prefetch_packet(const SurfaceKernel& kernel, const RayPacket& hits) { prefetch_triangles(*kernel.geometry->arrays, hits); }

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
