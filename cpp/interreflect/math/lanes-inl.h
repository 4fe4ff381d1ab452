// Vectors of lanes, one value a lane, three of them a direction or a point. Included once for every vector target.
#if defined(INTERREFLECT_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_LANES
#undef INTERREFLECT_LANES
#else
#define INTERREFLECT_LANES
#endif

#include <hwy/highway.h>

#include "math/vectors.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// At most sixteen lanes: those of a ray packet.
using Tag = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Tag>;
using LaneMask = hn::Mask<Tag>;

struct Vec3 {
    Vector x, y, z;
};
HWY_INLINE Vector dot(const Vec3& a, const Vec3& b) { return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z))); }
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
    return {hn::NegMulAdd(a.z, b.y, hn::Mul(a.y, b.z)), hn::NegMulAdd(a.x, b.z, hn::Mul(a.z, b.x)),
            hn::NegMulAdd(a.y, b.x, hn::Mul(a.x, b.y))};
}
HWY_INLINE Vec3 scaled(const Vec3& a, Vector s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
/// a + b s
HWY_INLINE Vec3 moved(const Vec3& a, const Vec3& b, Vector s) {
    return {hn::MulAdd(b.x, s, a.x), hn::MulAdd(b.y, s, a.y), hn::MulAdd(b.z, s, a.z)};
}
/// a where the mask holds, b elsewhere.
template <class M>
HWY_INLINE Vec3 choose(M mask, const Vec3& a, const Vec3& b) {
    return {hn::IfThenElse(mask, a.x, b.x), hn::IfThenElse(mask, a.y, b.y), hn::IfThenElse(mask, a.z, b.z)};
}
HWY_INLINE Vec3 negated(const Vec3& a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
HWY_INLINE void store3(const Vec3& a, float* to) { hn::StoreInterleaved3(a.x, a.y, a.z, Tag(), to); }

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
