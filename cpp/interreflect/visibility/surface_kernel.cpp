#include "visibility/surface_kernel.h"

#include <array>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/surface_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "visibility/surface_kernel-inl.h"

#if HWY_ONCE
namespace interreflect {
namespace {

/// Linear values of sRGB bytes.
const float* linear_values() {
    static const auto table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = srgb_to_linear(static_cast<std::uint8_t>(i));
        return values;
    }();
    return table.data();
}

void set3(SurfacePacket::Lanes* rows, int lane, const vec3& v) { rows[0][lane] = v.x, rows[1][lane] = v.y, rows[2][lane] = v.z; }

}  // namespace

void SurfacePacket::set(int lane, const SurfacePoint& point) {
    set3(position, lane, point.position);
    set3(geometric_normal, lane, point.geometric_normal);
    set3(normal, lane, point.normal);
    set3(albedo, lane, point.albedo);
    offset[lane] = point.offset;
    material[lane] = point.material;
    lobe[lane] = max_component(point.specular) > 0.0f ? point.material : no_lobe;
}

HWY_EXPORT(plain_packet);
HWY_EXPORT(place_packet);
HWY_EXPORT(texture_packet);
HWY_EXPORT(prefetch_packet);

std::uint32_t plain_surfaces(const SurfaceKernel& kernel, const RayPacket& hits, std::uint32_t active) {
    return HWY_DYNAMIC_DISPATCH(plain_packet)(kernel, hits, active);
}
void place_surfaces(const SurfaceKernel& kernel, const RayPacket& hits, std::uint32_t plain, SurfacePacket& surfaces) {
    HWY_DYNAMIC_DISPATCH(place_packet)(kernel, hits, plain, surfaces);
}
void texture_surfaces(const SurfaceKernel& kernel, std::uint32_t plain, SurfacePacket& surfaces) {
    HWY_DYNAMIC_DISPATCH(texture_packet)(kernel, plain, linear_values(), surfaces);
}
void prefetch_hits(const SurfaceKernel& kernel, const RayPacket& hits) { HWY_DYNAMIC_DISPATCH(prefetch_packet)(kernel, hits); }

}  // namespace interreflect
#endif
