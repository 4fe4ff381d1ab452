// Packets of triangles as vectors. Sums and products are rounded one by one, as they are outside of vectors: whether a triangle
// is voxelized must not hang on the processor. Included once for every vector target.
#if defined(INTERREFLECT_TRIANGLE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_TRIANGLE_LANES
#undef INTERREFLECT_TRIANGLE_LANES
#else
#define INTERREFLECT_TRIANGLE_LANES
#endif

#include <cstring>

#include "math/lanes-inl.h"
#include "voxels/voxelize/triangle_packet.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE std::uint32_t bits_of(LaneMask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Tag(), mask, bytes);
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof(bits));
    return bits;
}
HWY_INLINE Vec3 difference(const Vec3& a, const Vec3& b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE Vec3 rounded_cross(const Vec3& a, const Vec3& b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}
HWY_INLINE Vec3 load_axes(const TrianglePacket::Lanes* from, int k) {
    const Tag d;
    return {hn::Load(d, from[0] + k), hn::Load(d, from[1] + k), hn::Load(d, from[2] + k)};
}
HWY_INLINE Vec3 lowest(const Vec3* corner) {
    const auto of = [](Vector a, Vector b, Vector c) HWY_ATTR { return hn::Min(hn::Min(a, b), c); };
    return {of(corner[0].x, corner[1].x, corner[2].x), of(corner[0].y, corner[1].y, corner[2].y),
            of(corner[0].z, corner[1].z, corner[2].z)};
}
HWY_INLINE Vec3 highest(const Vec3* corner) {
    const auto of = [](Vector a, Vector b, Vector c) HWY_ATTR { return hn::Max(hn::Max(a, b), c); };
    return {of(corner[0].x, corner[1].x, corner[2].x), of(corner[0].y, corner[1].y, corner[2].y),
            of(corner[0].z, corner[1].z, corner[2].z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
