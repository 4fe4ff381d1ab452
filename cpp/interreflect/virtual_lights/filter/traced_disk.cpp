#include "virtual_lights/filter/traced_disk.h"

#include <bit>

#include "math/sampling.h"
#include "math/stratified.h"

namespace interreflect {

void visibility(const TracedDisk& technique, const ShadowedLight& light, const Receivers& receivers,
                const PerReceiver& irradiance, std::uint32_t seed, PerReceiver& visible, Counts& counts) {
    const DiskLight& disk = light.disk;
    const vec3 middle = disk.position + disk.normal * disk.offset;
    const float radius = disk.radius();
    const auto samples = static_cast<std::uint32_t>(technique.samples);
    for (int i = 0; i < receivers.count; ++i) {
        if (!(irradiance[i] > 0.0f)) continue;
        const vec3 origin = receivers.position_at(i) + receivers.geometric_normal_at(i) * receivers.offset[i];
        const StratifiedPoints points(seed, receivers.pixel[i], static_cast<std::uint32_t>(disk.index));
        std::uint32_t seen = 0;
        for (std::uint32_t first = 0; first < samples; first += RayPacket::width) {
            const std::uint32_t lanes = std::min<std::uint32_t>(samples - first, RayPacket::width);
            RayPacket packet;
            for (std::uint32_t k = 0; k < lanes; ++k) {
                const vec2 at = concentric_disk(points.point(first + k)) * radius;
                const vec3 to = middle + light.frame.tangent * at.x + light.frame.bitangent * at.y - origin;
                // Ends short of the surface on which the disk lies.
                packet.set(static_cast<int>(k), {origin, 0.0f, to, 1.0f - 0x1p-14f});
            }
            const std::uint32_t active = (1U << lanes) - 1U;
            seen += lanes - static_cast<std::uint32_t>(std::popcount(light.intersector.occluded(packet, active)));
        }
        counts.shadow_rays += samples;
        visible[i] = static_cast<float>(seen) / static_cast<float>(samples);
    }
}

}  // namespace interreflect
