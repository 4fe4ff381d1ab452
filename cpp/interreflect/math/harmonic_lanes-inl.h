// Spherical harmonics of vectors of directions (math/spherical_harmonics.h). Included once for every vector target.
#if defined(INTERREFLECT_HARMONIC_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_HARMONIC_LANES
#undef INTERREFLECT_HARMONIC_LANES
#else
#define INTERREFLECT_HARMONIC_LANES
#endif

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Calls visit(l, m, p, c, s) for every m from 0 and l from m: y_l^m(d) = norm p c, and y_l^-m(d) = norm p s, by harmonic_norms.
template <int bands, class Visit>
HWY_INLINE void visit_harmonics(const Vec3& direction, const Visit& visit) {
    const Tag d;
    Vector cosine = hn::Set(d, 1.0f), sine = hn::Zero(d);
    float diagonal = 1.0f;
    for (int m = 0; m < bands; ++m) {
        Vector before = hn::Zero(d), now = hn::Set(d, diagonal);
        for (int l = m; l < bands; ++l) {
            visit(l, m, now, cosine, sine);
            const float rest = 1.0f / static_cast<float>(l + 1 - m);
            const Vector next = hn::MulSub(hn::Mul(direction.z, hn::Set(d, static_cast<float>(2 * l + 1) * rest)), now,
                                           hn::Mul(before, hn::Set(d, static_cast<float>(l + m) * rest)));
            before = now, now = next;
        }
        diagonal *= static_cast<float>(2 * m + 1);
        const Vector turned = hn::MulSub(direction.x, cosine, hn::Mul(direction.y, sine));
        sine = hn::MulAdd(direction.x, sine, hn::Mul(direction.y, cosine));
        cosine = turned;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
