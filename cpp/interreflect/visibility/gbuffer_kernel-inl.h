// The packet kernel of the G-buffer. Included once for every vector target.
#if defined(INTERREFLECT_GBUFFER_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_GBUFFER_KERNEL
#undef INTERREFLECT_GBUFFER_KERNEL
#else
#define INTERREFLECT_GBUFFER_KERNEL
#endif

#include "visibility/camera_lanes-inl.h"
#include "visibility/face_lanes-inl.h"
#include "visibility/interpolate_kernel-inl.h"
#include "visibility/texture_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One packet on its way from rays to pixels; every array is sixteen lanes.
struct Shaded {
    alignas(64) FloatLanes direction_length;  // of the unnormalised ray
    alignas(64) FloatLanes u, v, area, reflects;
    alignas(64) FloatLanes albedo[3], specular[3], alpha;
    alignas(64) float position[3 * packet], geometric[3 * packet], normal[3 * packet], albedo_out[3 * packet],
        specular_out[3 * packet];
    alignas(64) FloatLanes offset;
    alignas(64) std::uint32_t body[packet];
    TexelPlaces texels;
};

/// Primary rays through the centres of the 4 x 4 pixels from (x0, y0) on.
HWY_INLINE void fill_rays(const CameraRays& rays, int x0, int y0, RayPacket& packet_rays, Shaded& s) {
    alignas(64) FloatLanes column, row;
    for (int k = 0; k < packet; ++k) {
        const int x = k % 4, y = k / 4;
        column[k] = static_cast<float>(x);
        row[k] = static_cast<float>(y);
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

/// Reflectances before textures, whether the side that is seen reflects at all, and bodies.
HWY_INLINE void look_up_faces(const GBufferJob& job, const Faces& faces, Shaded& s) {
    const Tag d;
    const hn::RebindToUnsigned<Tag> du;
    for (int f = 0; f < faces.count; ++f) {
        const KernelMaterial& m = job.materials[faces.material[f]];
        const auto body = hn::Set(du, job.scene.geometry->instances[faces.instance[f]].body);
        for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
            const LaneMask mine = mask_from(f == 0 ? all_lanes : faces.lanes[f], k);
            for (int c = 0; c < 3; ++c) {
                hn::BlendedStore(hn::Set(d, m.albedo[c]), mine, d, s.albedo[c] + k);
                hn::BlendedStore(hn::Set(d, m.specular[c]), mine, d, s.specular[c] + k);
            }
            hn::BlendedStore(hn::Set(d, m.alpha), mine, d, s.alpha + k);
            hn::BlendedStore(hn::Set(d, m.two_sided ? 1.0f : 0.0f), mine, d, s.reflects + k);
            hn::BlendedStore(body, hn::RebindMask(du, mine), du, s.body + k);
        }
    }
}

/// Normals, ray offsets, and the footprint's area in texture coordinates.
HWY_INLINE void shade_geometry(const GBufferJob& job, const RayPacket& hits, const Faces& faces, Shaded& s) {
    const Tag d;
    const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        const FacePoint at = interpolate_faces(*job.scene.geometry->arrays, hits, faces, k);
        const Vec3 direction{hn::Load(d, hits.direction_x + k), hn::Load(d, hits.direction_y + k),
                             hn::Load(d, hits.direction_z + k)};
        const Vec3 plane = cross(at.edge1, at.edge2);
        const Vector facing = dot(plane, direction);
        const auto front = hn::Lt(facing, zero);
        const Vec3 upward = scaled(plane, hn::Div(one, hn::Sqrt(dot(plane, plane))));
        const Vec3 geometric = choose(front, upward, negated(upward));

        const Vec3 normal = visible_normal_lanes(at.shading, geometric, direction);

        // Area of the pixel's footprint on the plane is pixel_area depth^2 / (length^3 cosine); the triangle's areas in texture
        // coordinates and in space turn it into texture coordinates.
        const Vector depth = hn::Load(d, hits.far + k), length = hn::Load(d, s.direction_length + k);
        const Vector area = hn::Div(hn::Mul(hn::Mul(hn::Mul(depth, depth), at.texture), hn::Set(d, job.pixel_area)),
                                    hn::Mul(hn::Mul(hn::Mul(length, length), length), hn::Abs(facing)));
        hn::Store(at.u, d, s.u + k);
        hn::Store(at.v, d, s.v + k);
        hn::Store(area, d, s.area + k);
        hn::Store(hn::Mul(hn::Set(d, 0x1p-18f), at.largest), d, s.offset + k);
        hn::Store(hn::IfThenElse(front, one, hn::Load(d, s.reflects + k)), d, s.reflects + k);
        store3(at.position, s.position + 3 * k);
        store3(geometric, s.geometric + 3 * k);
        store3(normal, s.normal + 3 * k);
    }
}

/// Where the texels of all lanes lie; asks for them.
HWY_INLINE void place_textures(const GBufferJob& job, const Faces& faces, Shaded& s) {
    const Tag d;
    s.texels.textured = 0;
    s.texels.blended = s.texels.wrapped = false;
    for (int f = 0; f < faces.count; ++f) {
        const KernelMaterial& material = job.materials[faces.material[f]];
        const std::uint32_t lanes = lanes_of_material(faces, f);
        if (material.texels == nullptr || (lanes & s.texels.textured) != 0) continue;
        s.texels.textured |= lanes;
        for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d)))
            place_texels(material, k, mask_from(lanes, k), hn::Load(d, s.u + k), hn::Load(d, s.v + k), hn::Load(d, s.area + k),
                         s.texels);
        for (std::uint32_t left = lanes; left != 0; left &= left - 1) {
            const std::size_t k = hwy::Num0BitsBelowLS1Bit_Nonzero32(left);
            for (int row = 0; row < TexelPlaces::rows; ++row) hwy::Prefetch(material.texels + s.texels.left[row][k]);
        }
    }
}

HWY_INLINE void shade_materials(Shaded& s) {
    const Tag d;
    const Vector one = hn::Set(d, 1.0f);
    for (int k = 0; k < packet; k += static_cast<int>(hn::Lanes(d))) {
        const Vector reflects = hn::Load(d, s.reflects + k);
        Vec3 albedo{hn::Load(d, s.albedo[0] + k), hn::Load(d, s.albedo[1] + k), hn::Load(d, s.albedo[2] + k)};
        if (s.texels.textured != 0) {
            const LaneMask textured = mask_from(s.texels.textured, k);
            const Rgb<Vector> texel = filtered_lanes(s.texels, k);
            albedo = {hn::Mul(albedo.x, hn::IfThenElse(textured, texel.r, one)),
                      hn::Mul(albedo.y, hn::IfThenElse(textured, texel.g, one)),
                      hn::Mul(albedo.z, hn::IfThenElse(textured, texel.b, one))};
        }
        store3(scaled(albedo, reflects), s.albedo_out + 3 * k);
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
        store_row<1>(s.body, lane, columns, g.body.data(), pixel);
    }
}

/// A packet between two steps. Several are on their way at once: each step asks the memory for what the next one reads.
struct Slot {
    RayPacket rays;
    Shaded s;
    std::uint32_t active, plain;
    Faces faces;
};

HWY_INLINE void trace_rays(const GBufferJob& job, const Tile& tile, int x0, int y0, Slot& slot) {
    fill_rays(job.rays, x0, y0, slot.rays, slot.s);
    slot.active = 0;
    for (int k = 0; k < packet; ++k) slot.active |= static_cast<std::uint32_t>(x0 + k % 4 < tile.x1 && y0 + k / 4 < tile.y1) << k;
    job.intersector.nearest(slot.rays, slot.active);
    find_faces(*job.scene.geometry->arrays, slot.rays, slot.faces);
}

HWY_INLINE void ask_for_vertices(const GBufferJob& job, Slot& slot) {
    slot.plain = plain_faces(*job.scene.geometry, job.materials.data(), slot.faces);
}

HWY_INLINE void shade_surfaces(const GBufferJob& job, Slot& slot) {
    if (slot.plain == 0) return;
    look_up_faces(job, slot.faces, slot.s);
    shade_geometry(job, slot.rays, slot.faces, slot.s);
    place_textures(job, slot.faces, slot.s);
}

HWY_INLINE void read_textures(const GBufferJob& job, Slot& slot) {
    if (slot.plain == 0 || slot.s.texels.textured == 0) return;
    const Faces& faces = slot.faces;
    if (lanes_of_material(faces, 0) == all_lanes) {
        read_texels(job.materials[faces.material[0]].texels, 0, packet, slot.s.texels);
        return;
    }
    for (int f = 0; f < faces.count; ++f) {
        const std::uint32_t* texels = job.materials[faces.material[f]].texels;
        if (texels == nullptr) continue;
        for (std::uint32_t left = faces.lanes[f]; left != 0; left &= left - 1) {
            const int k = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
            read_texels(texels, k, k + 1, slot.s.texels);
        }
    }
}

HWY_INLINE void finish_pixels(const GBufferJob& job, const Tile& tile, int x0, int y0, Slot& slot) {
    if (slot.plain != 0) {
        shade_materials(slot.s);
        store_packet(job, tile, x0, y0, slot.rays, slot.s);
    }
    for (std::uint32_t left = slot.active & ~slot.plain; left != 0; left &= left - 1) {
        const int k = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
        store_gbuffer_pixel(job, x0 + k % 4, y0 + k / 4, slot.rays.hit(k));
    }
}

HWY_INLINE void ask_for_line(const void* image, std::size_t begin, std::size_t end) {
    const char* at = static_cast<const char*>(image);
    for (std::size_t i = begin; i < end; i += 64) hwy::Prefetch(at + i);
}

/// The memory that a row of packets will write: 192 lines of cache, which must be read before they are partly written.
HWY_INLINE void ask_for_pixels(const GBufferJob& job, const Tile& tile, int x0, int y0) {
    GBuffer& g = job.g;
    const vec3* const wide[] = {g.position.data(), g.geometric_normal.data(), g.normal.data(),
                                g.albedo.data(),   g.specular.data(),         g.emission.data()};
    const void* const narrow[] = {g.alpha.data(),    g.depth.data(),    g.offset.data(),
                                  g.triangle.data(), g.instance.data(), g.body.data()};
    for (int y = y0; y < y0 + 4 && y < tile.y1; ++y) {
        const std::size_t begin = static_cast<std::size_t>(y) * g.width + x0, end = begin + (tile.x1 - x0);
        for (const vec3* image : wide) ask_for_line(image, 12 * begin, 12 * end);
        for (const void* image : narrow) ask_for_line(image, 4 * begin, 4 * end);
    }
}

void trace_tile(const GBufferJob& job, const Tile& tile) {
    constexpr int together = 8;  // the last packet is placed while the first one's texels come; all fit a first-level cache
    Slot slots[together];
    for (int y = tile.y0; y < tile.y1; y += 4)
        for (int begin = tile.x0; begin < tile.x1; begin += 4 * together) {
            const int count = tile.x1 - begin < 4 * together ? (tile.x1 - begin + 3) / 4 : together;
            ask_for_pixels(job, tile, begin, y);
            for (int i = 0; i < count; ++i) trace_rays(job, tile, begin + 4 * i, y, slots[i]);
            for (int i = 0; i < count; ++i) ask_for_vertices(job, slots[i]);
            for (int i = 0; i < count; ++i) shade_surfaces(job, slots[i]);
            for (int i = 0; i < count; ++i) read_textures(job, slots[i]);
            for (int i = 0; i < count; ++i) finish_pixels(job, tile, begin + 4 * i, y, slots[i]);
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
