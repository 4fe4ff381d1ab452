// Which neighbours lie on a pixel's own surface, for a vector of pixels. Included once for every vector target.
#if defined(INTERREFLECT_SAME_SURFACE) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_SAME_SURFACE
#undef INTERREFLECT_SAME_SURFACE
#else
#define INTERREFLECT_SAME_SURFACE
#endif

#include <cmath>

#include "math/lanes-inl.h"
#include "shading/share/interleaved.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The angles of a picture's pixels and of normals that share.
struct SharedAngles {
    float least_cosine, plane_distance;  // of a pixel's plane, at depth 1

    SharedAngles(const Interleaved& share, const GBuffer& gbuffer) {
        // A normal of 0 shares with none.
        const float cosine = std::cos(static_cast<float>(share.normal_angle) * degrees_to_radians);
        least_cosine = cosine > 1e-3f ? cosine : 1e-3f;
        const float half = std::tan(0.5f * gbuffer.camera.fov_x * degrees_to_radians);
        plane_distance = 2.0f * half / static_cast<float>(gbuffer.width) * static_cast<float>(share.plane_distance);
    }
};

/// The surfaces of a vector of pixels.
struct OwnSurface {
    Vec3 position, normal;
    Vector tolerance, least_cosine;

    HWY_INLINE OwnSurface(const SharedAngles& angles, const Vec3& at, const Vec3& facing, Vector depth)
        : position(at),
          normal(facing),
          tolerance(hn::Mul(depth, hn::Set(Tag(), angles.plane_distance))),
          least_cosine(hn::Set(Tag(), angles.least_cosine)) {}
    HWY_INLINE LaneMask holds(const Vec3& at, const Vec3& facing) const {
        const Vec3 to{hn::Sub(at.x, position.x), hn::Sub(at.y, position.y), hn::Sub(at.z, position.z)};
        return hn::And(hn::Ge(dot(normal, facing), least_cosine), hn::Le(hn::Abs(dot(normal, to)), tolerance));
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
