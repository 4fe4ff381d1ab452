// The packet kernel of the G-buffer. Included once for every vector target.
#if defined(INTERREFLECT_GBUFFER_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_GBUFFER_KERNEL
#undef INTERREFLECT_GBUFFER_KERNEL
#else
#define INTERREFLECT_GBUFFER_KERNEL
#endif

#include "visibility/camera_lanes-inl.h"
#include "visibility/interpolate_kernel-inl.h"
#include "visibility/texture_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One packet on its way from rays to pixels; every array is sixteen lanes.
struct Shaded : Interpolated {
    alignas(64) FloatLanes direction_length;  // of the unnormalised ray
    alignas(64) FloatLanes u, v, area, reflects;
    alignas(64) FloatLanes albedo[3], specular[3], alpha;
    alignas(64) float position[3 * packet], geometric[3 * packet], normal[3 * packet], albedo_out[3 * packet],
        specular_out[3 * packet];
    alignas(64) FloatLanes offset;
};

/// Primary rays through the centres of the 4 x 4 pixels from (x0, y0) on.
HWY_INLINE void fill_rays(const CameraRays& rays, int x0, int y0, RayPacket& packet_rays, Shaded& s) {
    alignas(64) FloatLanes column, row;
    for (int k = 0; k < packet; ++k) {
        column[k] = static_cast<float>(k % 4);
        row[k] = static_cast<float>(k / 4);
    }
    const Tag d;
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        const Vector x = hn::Add(hn::Load(d, column + k), hn::Set(d, static_cast<float>(x0) + 0.5f));
        const Vector y = hn::Add(hn::Load(d, row + k), hn::Set(d, static_cast<float>(y0) + 0.5f));
        const Vec3 direction = towards_places(rays, x, y);
        const Vector length = hn::Sqrt(dot(direction, direction));
        const Vec3 unit = scaled(direction, hn::Div(hn::Set(d, 1.0f), length));
        hn::Store(length, d, s.direction_length + k);
        hn::Store(unit.x, d, packet_rays.direction_x + k);
        hn::Store(unit.y, d, packet_rays.direction_y + k);
        hn::Store(unit.z, d, packet_rays.direction_z + k);
        hn::Store(hn::Set(d, rays.origin.x), d, packet_rays.origin_x + k);
        hn::Store(hn::Set(d, rays.origin.y), d, packet_rays.origin_y + k);
        hn::Store(hn::Set(d, rays.origin.z), d, packet_rays.origin_z + k);
        hn::Store(hn::Zero(d), d, packet_rays.near + k);
        hn::Store(hn::Inf(d), d, packet_rays.far + k);
    }
}

/// Reflectances before textures, and whether the side that is seen reflects at all.
HWY_INLINE void look_up_materials(const GBufferJob& job, Shaded& s) {
    for (int k = 0; k < packet; ++k) {
        const KernelMaterial& m = job.materials[s.material[k]];
        for (int c = 0; c < 3; ++c) s.albedo[c][k] = m.albedo[c], s.specular[c][k] = m.specular[c];
        s.alpha[k] = m.alpha;
        s.reflects[k] = m.two_sided ? 1.0f : 0.0f;
    }
}

/// Normals, ray offsets, and the footprint's area in texture coordinates.
HWY_INLINE void shade_geometry(const RayPacket& hits, float pixel_area, Shaded& s) {
    const Tag d;
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        Vec3 position, shading, e1, e2, largest;
        Vector u, v, unused, du1, dv1, du2, dv2;
        hn::LoadInterleaved4(d, s.position_normal[k], position.x, position.y, position.z, shading.x);
        hn::LoadInterleaved4(d, s.normal_texcoord[k], shading.y, shading.z, u, v);
        hn::LoadInterleaved4(d, s.edge1[k], e1.x, e1.y, e1.z, unused);
        hn::LoadInterleaved4(d, s.edge1_texcoord[k], unused, unused, du1, dv1);
        hn::LoadInterleaved4(d, s.edge2[k], e2.x, e2.y, e2.z, unused);
        hn::LoadInterleaved4(d, s.edge2_texcoord[k], unused, unused, du2, dv2);
        hn::LoadInterleaved4(d, s.largest[k], largest.x, largest.y, largest.z, unused);
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const Vec3 direction{hn::Load(d, hits.direction_x + k), hn::Load(d, hits.direction_y + k),
                             hn::Load(d, hits.direction_z + k)};
        const Vec3 plane = cross(e1, e2);
        const Vector facing = dot(plane, direction);
        const auto front = hn::Lt(facing, zero);
        const Vec3 upward = scaled(plane, hn::Div(one, hn::Sqrt(dot(plane, plane))));
        const Vec3 geometric = choose(front, upward, negated(upward));

        const Vec3 normal = visible_normal_lanes(shading, geometric, direction);

        // Area of the pixel's footprint on the plane is pixel_area depth^2 / (length^3 cosine); the triangle's areas in texture
        // coordinates and in space turn it into texture coordinates.
        const Vector depth = hn::Load(d, hits.far + k), length = hn::Load(d, s.direction_length + k);
        const Vector texture = hn::Abs(hn::Sub(hn::Mul(du1, dv2), hn::Mul(du2, dv1)));
        const Vector area = hn::Div(hn::Mul(hn::Mul(hn::Mul(depth, depth), texture), hn::Set(d, pixel_area)),
                                    hn::Mul(hn::Mul(hn::Mul(length, length), length), hn::Abs(facing)));
        hn::Store(u, d, s.u + k);
        hn::Store(v, d, s.v + k);
        hn::Store(area, d, s.area + k);
        hn::Store(hn::Mul(hn::Set(d, 0x1p-18f), hn::Max(largest.x, hn::Max(largest.y, largest.z))), d, s.offset + k);
        hn::Store(hn::IfThenElse(front, one, hn::Load(d, s.reflects + k)), d, s.reflects + k);
        store3(position, s.position + 3 * k);
        store3(geometric, s.geometric + 3 * k);
        store3(normal, s.normal + 3 * k);
    }
}

/// Multiplies the albedo of the lanes that have `material` by its texture.
HWY_INLINE void apply_texture(const KernelMaterial& material, std::uint32_t number, Shaded& s) {
    const Tag d;
    const hn::RebindToUnsigned<Tag> du;
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        const auto mine = hn::RebindMask(d, hn::Eq(hn::LoadU(du, s.material + k), hn::Set(du, number)));
        if (hn::AllFalse(d, mine)) continue;
        // Other lanes repeat a look-up near the origin of the texture; what they find is not kept.
        const Rgb<Vector> texel =
            filtered_lanes(d, material, hn::IfThenElseZero(mine, hn::Load(d, s.u + k)),
                           hn::IfThenElseZero(mine, hn::Load(d, s.v + k)), hn::IfThenElseZero(mine, hn::Load(d, s.area + k)));
        const Vector one = hn::Set(d, 1.0f);
        hn::Store(hn::Mul(hn::Load(d, s.albedo[0] + k), hn::IfThenElse(mine, texel.r, one)), d, s.albedo[0] + k);
        hn::Store(hn::Mul(hn::Load(d, s.albedo[1] + k), hn::IfThenElse(mine, texel.g, one)), d, s.albedo[1] + k);
        hn::Store(hn::Mul(hn::Load(d, s.albedo[2] + k), hn::IfThenElse(mine, texel.b, one)), d, s.albedo[2] + k);
    }
}

HWY_INLINE void shade_materials(const GBufferJob& job, std::uint32_t plain, Shaded& s) {
    std::uint32_t left = plain;
    while (left != 0) {
        const std::uint32_t number = s.material[hwy::Num0BitsBelowLS1Bit_Nonzero32(left)];
        if (job.materials[number].texels != nullptr) apply_texture(job.materials[number], number, s);
        for (int k = 0; k < packet; ++k) left &= ~(static_cast<std::uint32_t>(s.material[k] == number) << k);
    }
    const Tag d;
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        const Vector reflects = hn::Load(d, s.reflects + k);
        store3(scaled({hn::Load(d, s.albedo[0] + k), hn::Load(d, s.albedo[1] + k), hn::Load(d, s.albedo[2] + k)}, reflects),
               s.albedo_out + 3 * k);
        store3(scaled({hn::Load(d, s.specular[0] + k), hn::Load(d, s.specular[1] + k), hn::Load(d, s.specular[2] + k)}, reflects),
               s.specular_out + 3 * k);
    }
}

/// Four pixels of one row, `values` numbers each, to their place; fewer at the picture's right border.
template <int values>
HWY_INLINE void store_row(const void* from, int lane, int count, void* to, std::size_t pixel) {
    const char* source = static_cast<const char*>(from) + lane * values * 4;
    char* target = static_cast<char*>(to) + pixel * values * 4;
    if (count == 4)
        std::memcpy(target, source, 4 * values * 4);
    else
        std::memcpy(target, source, static_cast<std::size_t>(count) * values * 4);
}

HWY_INLINE void store_packet(const GBufferJob& job, const Tile& tile, int x0, int y0, const RayPacket& hits, const Shaded& s) {
    static const float zeros[3 * packet] = {};
    std::uint32_t body[packet];
    for (int k = 0; k < packet; ++k) body[k] = hits.met(k) ? job.scene.geometry->instances[hits.instance[k]].body : 0;
    GBuffer& g = job.g;
    const int columns = tile.x1 - x0 < 4 ? tile.x1 - x0 : 4, rows = tile.y1 - y0 < 4 ? tile.y1 - y0 : 4;
    for (int row = 0; row < rows; ++row) {
        const std::size_t pixel = static_cast<std::size_t>(y0 + row) * g.width + x0;
        const int lane = 4 * row;
        store_row<3>(s.position, lane, columns, g.position.data(), pixel);
        store_row<3>(s.geometric, lane, columns, g.geometric_normal.data(), pixel);
        store_row<3>(s.normal, lane, columns, g.normal.data(), pixel);
        store_row<3>(s.albedo_out, lane, columns, g.albedo.data(), pixel);
        store_row<3>(s.specular_out, lane, columns, g.specular.data(), pixel);
        store_row<3>(zeros, lane, columns, g.emission.data(), pixel);
        store_row<1>(s.alpha, lane, columns, g.alpha.data(), pixel);
        store_row<1>(hits.far, lane, columns, g.depth.data(), pixel);
        store_row<1>(s.offset, lane, columns, g.offset.data(), pixel);
        store_row<1>(hits.triangle, lane, columns, g.triangle.data(), pixel);
        store_row<1>(hits.instance, lane, columns, g.instance.data(), pixel);
        store_row<1>(body, lane, columns, g.body.data(), pixel);
    }
}

/// A packet between two steps. Several are on their way at once: each step asks the memory for what the next one reads.
struct Slot {
    RayPacket rays;
    Shaded s;
    std::uint32_t active, plain;
};

HWY_INLINE void trace_rays(const GBufferJob& job, const Tile& tile, int x0, int y0, Slot& slot) {
    fill_rays(job.rays, x0, y0, slot.rays, slot.s);
    slot.active = 0;
    for (int k = 0; k < packet; ++k) slot.active |= static_cast<std::uint32_t>(x0 + k % 4 < tile.x1 && y0 + k / 4 < tile.y1) << k;
    job.intersector.nearest(slot.rays, slot.active);
    prefetch_triangles(*job.scene.geometry->arrays, slot.rays);
}

HWY_INLINE void ask_for_vertices(const GBufferJob& job, Slot& slot) {
    slot.plain = plain_lanes(*job.scene.geometry, job.materials.data(), slot.rays, slot.active);
    prefetch_vertices(*job.scene.geometry->arrays, slot.rays, slot.plain);
}

/// The texels that the finer of the two levels needs; the coarser one's are four times fewer and mostly there already.
HWY_INLINE void ask_for_texels(const KernelMaterial& material, const Shaded& s) {
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    alignas(64) std::int32_t index[packet], below[packet];
    const auto* table = reinterpret_cast<const std::int32_t*>(material.levels);
    const Vector size = hn::Set(d, static_cast<float>(material.levels[0].width) * static_cast<float>(material.levels[0].height));
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        const Vector texels = hn::Max(hn::Mul(hn::Load(d, s.area + k), size), hn::Set(d, 1.0f));
        // Half the binary exponent is the level.
        const auto exponent = hn::Sub(hn::ShiftRight<23>(hn::BitCast(di, texels)), hn::Set(di, 127));
        const auto level = hn::Min(hn::ShiftRight<1>(exponent), hn::Set(di, material.level_count - 1));
        const auto at = hn::Add(hn::Add(level, level), level);
        const auto width = hn::GatherIndex(di, table, at), height = hn::GatherIndex(di, table + 1, at);
        const Vector u = wrap_lanes(d, hn::Load(d, s.u + k)), v = wrap_lanes(d, hn::Load(d, s.v + k));
        const auto x = hn::ConvertTo(di, hn::Mul(u, hn::ConvertTo(d, width)));
        const auto y = hn::ConvertTo(di, hn::Mul(v, hn::ConvertTo(d, height)));
        const auto texel = hn::Add(hn::GatherIndex(di, table + 2, at), hn::Add(hn::Mul(y, width), x));
        hn::Store(texel, di, index + k);
        hn::Store(hn::Max(hn::Sub(texel, width), hn::Zero(di)), di, below + k);
    }
    for (int k = 0; k < packet; ++k) {
        hwy::Prefetch(material.texels + index[k]);
        hwy::Prefetch(material.texels + below[k]);
    }
}

HWY_INLINE void shade_surfaces(const GBufferJob& job, Slot& slot) {
    if (slot.plain == 0) return;
    interpolate(*job.scene.geometry->arrays, slot.rays, slot.plain, slot.s);
    look_up_materials(job, slot.s);
    shade_geometry(slot.rays, job.pixel_area, slot.s);
    const KernelMaterial& material = job.materials[slot.s.material[hwy::Num0BitsBelowLS1Bit_Nonzero32(slot.plain)]];
    if (material.texels != nullptr) ask_for_texels(material, slot.s);
}

HWY_INLINE void finish_pixels(const GBufferJob& job, const Tile& tile, int x0, int y0, Slot& slot) {
    if (slot.plain != 0) {
        shade_materials(job, slot.plain, slot.s);
        store_packet(job, tile, x0, y0, slot.rays, slot.s);
    }
    for (std::uint32_t left = slot.active & ~slot.plain; left != 0; left &= left - 1) {
        const int k = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
        store_gbuffer_pixel(job, x0 + k % 4, y0 + k / 4, slot.rays.hit(k));
    }
}

void trace_tile(const GBufferJob& job, const Tile& tile) {
    constexpr int together = 4;  // 24 KiB, half of a first-level cache
    Slot slots[together];
    for (int y = tile.y0; y < tile.y1; y += 4)
        for (int begin = tile.x0; begin < tile.x1; begin += 4 * together) {
            const int count = tile.x1 - begin < 4 * together ? (tile.x1 - begin + 3) / 4 : together;
            for (int i = 0; i < count; ++i) trace_rays(job, tile, begin + 4 * i, y, slots[i]);
            for (int i = 0; i < count; ++i) ask_for_vertices(job, slots[i]);
            for (int i = 0; i < count; ++i) shade_surfaces(job, slots[i]);
            for (int i = 0; i < count; ++i) finish_pixels(job, tile, begin + 4 * i, y, slots[i]);
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
