#include "reference/path_kernel.h"

#include "reference/glossy_lanes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reference/path_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "reference/path_kernel-inl.h"

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(connect_directional_lanes);
HWY_EXPORT(connect_shapes_lanes);
HWY_EXPORT(connect_constant_sky_lanes);
HWY_EXPORT(connect_given_lanes);
HWY_EXPORT(choose_rays_lanes);
HWY_EXPORT(primary_rays_lanes);
HWY_EXPORT(append_lanes);
HWY_EXPORT(reorder_lanes);

void connect_directional(const Connecting& c, const vec3& towards, const vec3& irradiance) {
    HWY_DYNAMIC_DISPATCH(connect_directional_lanes)(c, towards, irradiance);
}
void connect_shapes(const Connecting& c, std::span<const EmitterShape> shapes, const PairTable& choices,
                    const PairTable& points) {
    HWY_DYNAMIC_DISPATCH(connect_shapes_lanes)(c, shapes.data(), static_cast<int>(shapes.size()), choices, points);
}
void connect_constant_sky(const Connecting& c, const vec3& radiance, const PairTable& points) {
    HWY_DYNAMIC_DISPATCH(connect_constant_sky_lanes)(c, radiance, points);
}
void connect_given(const Connecting& c, const LightColumns& lights) { HWY_DYNAMIC_DISPATCH(connect_given_lanes)(c, lights); }
void choose_rays(const Choosing& c, StepLanes& steps) { HWY_DYNAMIC_DISPATCH(choose_rays_lanes)(c, steps); }
void choose_primary_rays(const CameraRays& camera, int x0, int y0, const PairTable& places, StepLanes& steps) {
    HWY_DYNAMIC_DISPATCH(primary_rays_lanes)(camera, x0, y0, places, steps);
}
void append_paths(const SurfacePacket& surfaces, std::uint32_t lanes, const StepLanes& steps, std::uint32_t first,
                  PathLanes& paths) {
    HWY_DYNAMIC_DISPATCH(append_lanes)(surfaces, lanes, steps, first, paths);
}
void reorder_paths(const PathLanes& from, const NumberColumn& order, std::uint32_t count, PathLanes& to) {
    HWY_DYNAMIC_DISPATCH(reorder_lanes)(from, order, count, to);
}
}  // namespace interreflect
#endif
