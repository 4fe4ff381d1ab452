#include "shading/emitter_shape.h"

#include "shading/lights.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/emitter_shape.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shading/emitter_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

void sample_one(const EmitterShape* shapes, int count, const vec3& position, float choice, const vec2& u, LightDirection& light) {
    const LightLanes lanes = sample_shape_lanes(shapes, count, same(position), number(choice), number(u.x), number(u.y));
    const auto first = [](Vector v) HWY_ATTR { return hn::GetLane(v); };
    light.direction = {first(lanes.direction.x), first(lanes.direction.y), first(lanes.direction.z)};
    light.radiance = {first(lanes.radiance.x), first(lanes.radiance.y), first(lanes.radiance.z)};
    light.distance = first(lanes.distance);
    light.pdf = first(lanes.pdf);
}

float pdf_of_one(const EmitterShape* shapes, int count, const vec3& position, const vec3& direction, int which) {
    return hn::GetLane(shape_pdf_lanes(shapes, count, same(position), same(direction), which));
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(sample_one);
HWY_EXPORT(pdf_of_one);

LightDirection sample_shapes(std::span<const EmitterShape> shapes, const vec3& position, float choose, const vec2& u) {
    LightDirection light;
    HWY_DYNAMIC_DISPATCH(sample_one)(shapes.data(), static_cast<int>(shapes.size()), position, choose, u, light);
    return light.pdf > 0.0f ? light : LightDirection{};
}
float shapes_pdf(std::span<const EmitterShape> shapes, const vec3& position, const vec3& direction, int which) {
    return HWY_DYNAMIC_DISPATCH(pdf_of_one)(shapes.data(), static_cast<int>(shapes.size()), position, direction, which);
}
}  // namespace interreflect
#endif
