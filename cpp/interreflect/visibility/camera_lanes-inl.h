// Primary rays side by side, the same bits in the G-buffer and in the path tracer. Included once for every vector target.
#if defined(INTERREFLECT_CAMERA_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_CAMERA_LANES
#undef INTERREFLECT_CAMERA_LANES
#else
#define INTERREFLECT_CAMERA_LANES
#endif

#include "data/camera.h"
#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Towards places of the picture, in pixels; not unit.
HWY_INLINE Vec3 towards_places(const CameraRays& camera, Vector x, Vector y) {
    const Tag d;
    const auto along = [&](float corner, float right, float down) HWY_ATTR {
        return hn::MulAdd(hn::Set(d, down), y, hn::MulAdd(hn::Set(d, right), x, hn::Set(d, corner)));
    };
    return {along(camera.corner.x, camera.right_step.x, camera.down_step.x),
            along(camera.corner.y, camera.right_step.y, camera.down_step.y),
            along(camera.corner.z, camera.right_step.z, camera.down_step.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
