// A packet of neighbouring pixels by the triangles it met: mostly one to three. Included once for every vector target.
#if defined(INTERREFLECT_FACE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_FACE_LANES
#undef INTERREFLECT_FACE_LANES
#else
#define INTERREFLECT_FACE_LANES
#endif

#include <hwy/cache_control.h>

#include "visibility/kernel_material.h"
#include "visibility/packet_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Different triangles of a packet, and bit by bit the lanes that met each.
struct Faces {
    int count;
    std::uint32_t triangle[packet], instance[packet], material[packet], lanes[packet];
};

/// Asks for what plain_faces reads.
HWY_INLINE void find_faces(const GeometryArrays& arrays, const RayPacket& hits, Faces& faces) {
    faces.count = 0;
    for (std::uint32_t left = ~lanes_equal(hits.triangle, Hit{}.triangle) & all_lanes; left != 0;
         left &= ~faces.lanes[faces.count++]) {
        const std::size_t k = hwy::Num0BitsBelowLS1Bit_Nonzero32(left);
        const std::uint32_t triangle = hits.triangle[k], instance = hits.instance[k];
        hwy::Prefetch(arrays.triangles.data() + triangle);
        hwy::Prefetch(arrays.materials.data() + triangle);
        faces.triangle[faces.count] = triangle;
        faces.instance[faces.count] = instance;
        faces.lanes[faces.count] = lanes_equal(hits.triangle, triangle) & lanes_equal(hits.instance, instance);
    }
}

/// Keeps the faces that vectors may shade: in world space, with a plain material. Asks for their vertices; returns their lanes.
HWY_INLINE std::uint32_t plain_faces(const Geometry& geometry, const KernelMaterial* materials, Faces& faces) {
    const GeometryArrays& arrays = *geometry.arrays;
    const auto* triangles = reinterpret_cast<const std::uint32_t*>(arrays.triangles.data());
    std::uint32_t plain = 0;
    int kept = 0;
    for (int f = 0; f < faces.count; ++f) {
        const std::uint32_t triangle = faces.triangle[f], instance = faces.instance[f], material = arrays.materials[triangle];
        if (!geometry.instances[instance].identity || !materials[material].plain) continue;
        const std::uint32_t* corners = triangles + 3 * std::size_t{triangle};
        for (int c = 0; c < 3; ++c) hwy::Prefetch(arrays.vertices.data() + corners[c]);
        plain |= faces.lanes[f];
        faces.triangle[kept] = triangle;
        faces.instance[kept] = instance;
        faces.material[kept] = material;
        faces.lanes[kept++] = faces.lanes[f];
    }
    faces.count = kept;
    return plain;
}

/// The lanes of all faces that have the material of face f.
HWY_INLINE std::uint32_t lanes_of_material(const Faces& faces, int f) {
    std::uint32_t lanes = 0;
    for (int g = 0; g < faces.count; ++g)
        if (faces.material[g] == faces.material[f]) lanes |= faces.lanes[g];
    return lanes;
}

/// Interpolated by the lanes' own faces; 0 in lanes that have none.
struct FacePoint {
    Vec3 position, shading, edge1, edge2;
    Vector u, v;
    Vector texture;  // twice the triangle's area in texture coordinates
    Vector largest;  // magnitude of the corners' coordinates
};

HWY_INLINE void put(LaneMask lanes, Vector value, Vector& to) { to = hn::IfThenElse(lanes, value, to); }

/// Number i of a vertex.
HWY_INLINE void put_weighted(LaneMask lanes, const float* const corner[3], int i, const Vector weight[3], Vector& to) {
    const Tag d;
    const Vector two = hn::Add(hn::Mul(hn::Set(d, corner[0][i]), weight[0]), hn::Mul(hn::Set(d, corner[1][i]), weight[1]));
    put(lanes, hn::Add(two, hn::Mul(hn::Set(d, corner[2][i]), weight[2])), to);
}

HWY_INLINE float largest_coordinate(const float* const corner[3]) {
    const hn::CappedTag<float, 4> d;
    const auto a = hn::Abs(hn::Load(d, corner[0])), b = hn::Abs(hn::Load(d, corner[1])), c = hn::Abs(hn::Load(d, corner[2]));
    alignas(16) float largest[4];
    hn::Store(hn::Max(a, hn::Max(b, c)), d, largest);
    const float two = largest[0] > largest[1] ? largest[0] : largest[1];
    return two > largest[2] ? two : largest[2];
}

HWY_INLINE float texture_area(const float* const corner[3]) {
    const float du1 = corner[1][6] - corner[0][6], dv1 = corner[1][7] - corner[0][7];
    const float du2 = corner[2][6] - corner[0][6], dv2 = corner[2][7] - corner[0][7];
    const float area = du1 * dv2 - du2 * dv1;
    return area < 0.0f ? -area : area;
}

/// Lanes k and following.
HWY_INLINE FacePoint interpolate_faces(const GeometryArrays& arrays, const RayPacket& hits, const Faces& faces, int k) {
    const Tag d;
    const Vector zero = hn::Zero(d), u = hn::Load(d, hits.u + k), v = hn::Load(d, hits.v + k);
    const Vector weight[3] = {hn::Sub(hn::Sub(hn::Set(d, 1.0f), u), v), u, v};
    const Vec3 origin{zero, zero, zero};
    FacePoint at{origin, origin, origin, origin, zero, zero, zero, zero};
    const auto* triangles = reinterpret_cast<const std::uint32_t*>(arrays.triangles.data());
    const auto* vertices = reinterpret_cast<const float*>(arrays.vertices.data());
    for (int f = 0; f < faces.count; ++f) {
        const LaneMask lanes = mask_from(faces.lanes[f], k);
        const std::uint32_t* numbers = triangles + 3 * std::size_t{faces.triangle[f]};
        const float* const corner[3] = {vertices + 8 * std::size_t{numbers[0]}, vertices + 8 * std::size_t{numbers[1]},
                                        vertices + 8 * std::size_t{numbers[2]}};
        put_weighted(lanes, corner, 0, weight, at.position.x);
        put_weighted(lanes, corner, 1, weight, at.position.y);
        put_weighted(lanes, corner, 2, weight, at.position.z);
        put_weighted(lanes, corner, 3, weight, at.shading.x);
        put_weighted(lanes, corner, 4, weight, at.shading.y);
        put_weighted(lanes, corner, 5, weight, at.shading.z);
        put_weighted(lanes, corner, 6, weight, at.u);
        put_weighted(lanes, corner, 7, weight, at.v);
        put(lanes, hn::Set(d, corner[1][0] - corner[0][0]), at.edge1.x);
        put(lanes, hn::Set(d, corner[1][1] - corner[0][1]), at.edge1.y);
        put(lanes, hn::Set(d, corner[1][2] - corner[0][2]), at.edge1.z);
        put(lanes, hn::Set(d, corner[2][0] - corner[0][0]), at.edge2.x);
        put(lanes, hn::Set(d, corner[2][1] - corner[0][1]), at.edge2.y);
        put(lanes, hn::Set(d, corner[2][2] - corner[0][2]), at.edge2.z);
        put(lanes, hn::Set(d, texture_area(corner)), at.texture);
        put(lanes, hn::Set(d, largest_coordinate(corner)), at.largest);
    }
    return at;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
