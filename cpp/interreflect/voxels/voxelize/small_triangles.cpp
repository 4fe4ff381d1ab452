#include "voxels/voxelize/small_triangles.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/voxelize/small_triangles.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "voxels/voxelize/texel_lanes-inl.h"
#include "voxels/voxelize/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

HWY_INLINE Vec3 floors(const Vec3& p) { return {hn::Floor(p.x), hn::Floor(p.y), hn::Floor(p.z)}; }
HWY_INLINE LaneMask all_equal(const Vec3& a, const Vec3& b) {
    return hn::And(hn::And(hn::Eq(a.x, b.x), hn::Eq(a.y, b.y)), hn::Eq(a.z, b.z));
}
HWY_INLINE Vector square_of(const Vec3& a) { return hn::Add(hn::Add(hn::Mul(a.x, a.x), hn::Mul(a.y, a.y)), hn::Mul(a.z, a.z)); }

SmallTriangles find_small(const TrianglePacket& packet, float spacing) {
    const Tag d;
    SmallTriangles small{.spacing = spacing};
    for (int k = 0; k < TrianglePacket::width; k += static_cast<int>(hn::Lanes(d))) {
        const Vec3 a = load_axes(packet.corner[0], k), b = load_axes(packet.corner[1], k), c = load_axes(packet.corner[2], k);
        const LaneMask one = hn::And(all_equal(floors(a), floors(b)), all_equal(floors(a), floors(c)));
        const Vector longest =
            hn::Max(hn::Max(square_of(difference(b, a)), square_of(difference(c, b))), square_of(difference(a, c)));
        const LaneMask uncut = hn::Le(hn::Div(hn::Sqrt(longest), hn::Set(d, spacing)), hn::Set(d, 1.0f));
        small.in_one_cell |= bits_of(one) << k;
        small.uncut |= bits_of(hn::AndNot(one, uncut)) << k;
    }
    return small;
}

/// Texture coordinates of a packet's corners.
struct CornerTexcoords {
    Vector u[3], v[3];

    HWY_INLINE CornerTexcoords(const TrianglePacket& packet, const vec2* texcoords, int k) {
        const Tag d;
        const IntTag di;
        const auto* values = reinterpret_cast<const float*>(texcoords);
        for (int i = 0; i < 3; ++i) {
            const IntVector at = hn::ShiftLeft<1>(hn::Load(di, packet.vertex[i] + k));
            u[i] = hn::GatherIndex(d, values, at), v[i] = hn::GatherIndex(d, values + 1, at);
        }
    }
    /// Inside the triangle, `share` of the way from the centroid to a corner.
    HWY_INLINE Vector towards(const Vector* of, int corner, float share) const {
        const Tag d;
        const Vector mean = hn::Mul(hn::Add(hn::Add(of[0], of[1]), of[2]), hn::Set(d, 1.0f / 3.0f));
        return hn::Add(mean, hn::Mul(hn::Sub(of[corner], mean), hn::Set(d, share)));
    }
};

/// VoxelTriangle::level of samples that stand for `sample_area`, and where its texels are.
HWY_INLINE TexelLanes choose_level(const PlainLook& look, const CornerTexcoords& at, Vector sample_area, Vector area) {
    const Tag d;
    const IntTag di;
    const Vector du1 = hn::Sub(at.u[1], at.u[0]), du2 = hn::Sub(at.u[2], at.u[0]), dv1 = hn::Sub(at.v[1], at.v[0]),
                 dv2 = hn::Sub(at.v[2], at.v[0]);
    const Vector covered = hn::Mul(hn::Set(d, 0.5f), hn::Abs(hn::Sub(hn::Mul(du1, dv2), hn::Mul(dv1, du2))));
    const Vector share = hn::Div(hn::Mul(covered, sample_area), area);
    const Vector texels =
        hn::Mul(hn::Mul(share, hn::Set(d, static_cast<float>(look.levels[0]))), hn::Set(d, static_cast<float>(look.levels[1])));
    const IntVector exponent = hn::Sub(hn::ShiftRight<23>(hn::BitCast(di, texels)), hn::Set(di, 127));
    const IntVector nearest = hn::ShiftRight<1>(hn::Add(exponent, hn::Set(di, 1)));
    const IntVector level =
        hn::IfThenElseZero(hn::RebindMask(di, hn::Ge(texels, hn::Set(d, 2.0f))), hn::Min(nearest, hn::Set(di, look.last_level)));
    const IntVector entry = hn::Add(hn::Add(level, level), level);
    return {look.srgb, hn::GatherIndex(di, look.levels + 2, entry), hn::GatherIndex(di, look.levels, entry),
            hn::GatherIndex(di, look.levels + 1, entry)};
}

void sum_small_lanes(const TrianglePacket& packet, const SmallTriangles& small, const PlainLook& look, const vec2* texcoords,
                     const ivec3& cells, SmallTriangleSums& out) {
    const Tag d;
    const IntTag di;
    // Of the way to a corner, where its texel is looked up: on the border, a picture that repeats may show its other end.
    constexpr float outwards = 1.0f - 1e-3f;
    const float third = 1.0f / 3.0f;
    for (int k = 0; k < TrianglePacket::width; k += static_cast<int>(hn::Lanes(d))) {
        const Vec3 cross = load_axes(packet.cross, k);
        const Vector length = hn::Sqrt(square_of(cross)), scale = hn::Div(hn::Set(d, 1.0f), length);
        const Vec3 normal = scaled(cross, scale);
        hn::Store(normal.x, d, out.normal[0] + k);
        hn::Store(normal.y, d, out.normal[1] + k);
        hn::Store(normal.z, d, out.normal[2] + k);
        const Vector area = hn::Mul(hn::Set(d, 0.5f), length);
        const Vec3 corner[3] = {load_axes(packet.corner[0], k), load_axes(packet.corner[1], k), load_axes(packet.corner[2], k)};
        const Vec3 colour{hn::Set(d, look.albedo.r), hn::Set(d, look.albedo.g), hn::Set(d, look.albedo.b)};
        TexelLanes texels{nullptr, hn::Zero(di), hn::Zero(di), hn::Zero(di)};
        const CornerTexcoords at(packet, texcoords, k);
        if (look.srgb != nullptr) texels = choose_level(look, at, hn::Min(area, hn::Set(d, small.spacing * small.spacing)), area);
        const auto albedo = [&](int i, float share) HWY_ATTR {
            if (look.srgb == nullptr) return colour;
            return product(colour, texels.at(at.towards(at.u, i, share), at.towards(at.v, i, share)));
        };
        if (small.in_one_cell != 0) {
            const auto mean = [&](Vector a, Vector b, Vector c) HWY_ATTR {
                const Vector w = hn::Set(d, third);
                return hn::Add(hn::Add(hn::Mul(a, w), hn::Mul(b, w)), hn::Mul(c, w));
            };
            const Vec3 centroid{mean(corner[0].x, corner[1].x, corner[2].x), mean(corner[0].y, corner[1].y, corner[2].y),
                                mean(corner[0].z, corner[1].z, corner[2].z)};
            store_sums(centroid, area, albedo(0, 0.0f), cells, k, out.sums);
        }
        for (int i = 0; i < 3 && small.uncut != 0; ++i)
            store_sums(corner[i], hn::Mul(area, hn::Set(d, third)), albedo(i, outwards), cells,
                       TrianglePacket::width * (i + 1) + k, out.sums);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(find_small);
HWY_EXPORT(sum_small_lanes);

SmallTriangleEmitter::SmallTriangleEmitter(const Scene& scene, const Domain& domain, float spacing)
    : scene_(scene), cells_(domain.cells), spacing_(spacing), looks_(scene.materials.size()) {
    for (std::size_t i = 0; i < looks_.size(); ++i) {
        const Material& material = scene.materials[i];
        const Texture* map = material.albedo_map >= 0 ? scene.textures[material.albedo_map].get() : nullptr;
        PlainLook& look = looks_[i];
        look.plain = !material.emits() && material.mask < 0 && (map == nullptr || !map->srgb_texels().empty());
        look.two_sided = material.two_sided ? 1U : 0U;
        look.albedo = material.albedo;
        if (map == nullptr) continue;
        look.srgb = map->srgb_texels().data();
        look.levels = reinterpret_cast<const std::int32_t*>(map->level_table().data());
        look.last_level = map->levels() - 1;
    }
}

std::uint32_t SmallTriangleEmitter::operator()(const TrianglePacket& packet, std::uint32_t lanes, ContributionSink& sink) const {
    const SmallTriangles small = HWY_DYNAMIC_DISPATCH(find_small)(packet, spacing_);
    const std::uint32_t* materials = scene_.geometry->arrays->materials.data() + packet.first;
    std::uint32_t taken = 0;
    for (std::uint32_t left = lanes & (small.in_one_cell | small.uncut); left != 0;) {
        const std::uint32_t material = materials[std::countr_zero(left)];
        std::uint32_t alike = 0;
        for (std::uint32_t others = left; others != 0; others &= others - 1)
            if (materials[std::countr_zero(others)] == material) alike |= others & -others;
        left &= ~alike;
        if (!looks_[material].plain) continue;
        emit(packet, {small.in_one_cell & alike, small.uncut & alike, spacing_}, looks_[material], sink);
        taken |= alike;
    }
    return taken;
}

void SmallTriangleEmitter::emit(const TrianglePacket& packet, const SmallTriangles& small, const PlainLook& look,
                                ContributionSink& sink) const {
    SmallTriangleSums found;
    HWY_DYNAMIC_DISPATCH(sum_small_lanes)(packet, small, look, scene_.geometry->arrays->texcoords.data(), cells_, found);
    for (std::uint32_t lanes = small.in_one_cell | small.uncut; lanes != 0; lanes &= lanes - 1) {
        const int lane = std::countr_zero(lanes);
        vec3 normal(found.normal[0][lane], found.normal[1][lane], found.normal[2][lane]);
        if (packet.flips) normal = -normal;
        sink.begin({vec4(normal, packet.offset[lane]), look.two_sided});
        if (((small.in_one_cell >> lane) & 1U) != 0)
            sink.add_one_of(found.sums, lane);
        else
            for (int i = 1; i <= 3; ++i) sink.add_one_of(found.sums, TrianglePacket::width * i + lane);
        sink.end();
    }
}

}  // namespace interreflect
#endif
