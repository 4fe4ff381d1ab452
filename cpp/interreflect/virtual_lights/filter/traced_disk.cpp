#include "virtual_lights/filter/traced_disk.h"

#include <algorithm>
#include <bit>

#include "math/sampling.h"
#include "math/stratified.h"

namespace interreflect {
namespace {

/// A pixel, and the part of a light's members that it would be lit by, were nothing in between.
class LitMembers {
  public:
    LitMembers(const DiskLight& disk, const Receivers& receivers, int receiver) : places_(*disk.places) {
        const vec3 at = receivers.position_at(receiver), n = receivers.normal_at(receiver);
        const vec3 ground = receivers.geometric_normal_at(receiver);
        // A member's own disk keeps its share finite where it is near.
        const float own = disk.area / (pi * MemberPlaces::count);
        float weight[MemberPlaces::count];
        for (int i = 0; i < MemberPlaces::count; ++i) {
            const float x = places_.position[0][i] - at.x, y = places_.position[1][i] - at.y, z = places_.position[2][i] - at.z;
            const float below = x * n.x + y * n.y + z * n.z;
            const float above = -(x * places_.normal[0][i] + y * places_.normal[1][i] + z * places_.normal[2][i]);
            const float distance2 = x * x + y * y + z * z;
            const float squared = distance2 * (distance2 + own);
            const bool lights = below > 0.0f && above > 0.0f && x * ground.x + y * ground.y + z * ground.z > 0.0f;
            weight[i] = lights ? below * above / squared : 0.0f;
        }
        float sum = 0;
        for (int i = 0; i < MemberPlaces::count; ++i) until_[i] = sum += weight[i];
    }
    bool any() const { return until_[MemberPlaces::count - 1] > 0.0f; }
    /// In proportion to the light that it would bring.
    vec3 choose(float u) const {
        const float share = u * until_[MemberPlaces::count - 1];
        const auto i = std::min<std::ptrdiff_t>(std::upper_bound(until_, until_ + MemberPlaces::count, share) - until_,
                                                MemberPlaces::count - 1);
        return {places_.position[0][i], places_.position[1][i], places_.position[2][i]};
    }

  private:
    const MemberPlaces& places_;
    float until_[MemberPlaces::count];
};

/// Rays of several pixels, traced side by side.
class PixelRays {
  public:
    PixelRays(const Intersector& intersector, PerReceiver& unseen) : intersector_(intersector), unseen_(unseen) {}

    void add(int receiver, const vec3& from, const vec3& to) {
        // Ends short of the surface on which the light lies.
        packet_.set(count_, {from, 0.0f, to - from, 1.0f - 0x1p-14f});
        receiver_[count_++] = receiver;
        if (count_ == RayPacket::width) trace();
    }
    void trace() {
        const auto active = static_cast<std::uint32_t>((std::uint64_t{1} << count_) - 1U);
        for (std::uint32_t hit = intersector_.occluded(packet_, active); hit != 0; hit &= hit - 1)
            unseen_[receiver_[std::countr_zero(hit)]] += 1.0f;
        count_ = 0;
    }

  private:
    RayPacket packet_;  // first: it is aligned to 64 bytes
    const Intersector& intersector_;
    PerReceiver& unseen_;
    int receiver_[RayPacket::width];
    int count_ = 0;
};

}  // namespace

void visibility(const TracedDisk& technique, const ShadowedLight& light, const Receivers& receivers,
                const PerReceiver& irradiance, std::uint32_t seed, PerReceiver& visible, Counts& counts) {
    const DiskLight& disk = light.disk;
    const vec3 middle = disk.position + disk.normal * disk.offset;
    const float radius = disk.radius();
    const auto of_disk = [&](const vec2& u) {
        const vec2 at = concentric_disk(u) * radius;
        return middle + light.frame.tangent * at.x + light.frame.bitangent * at.y;
    };
    const auto samples = static_cast<std::uint32_t>(technique.samples);
    PerReceiver unseen;
    std::fill(unseen.value, unseen.value + receivers.count, static_cast<float>(samples));
    PixelRays rays(light.intersector, unseen);
    for (int i = 0; i < receivers.count; ++i) {
        if (!(irradiance[i] > 0.0f)) continue;
        const vec3 origin = receivers.position_at(i) + receivers.geometric_normal_at(i) * receivers.offset[i];
        const StratifiedPoints points(seed, receivers.pixel[i], static_cast<std::uint32_t>(disk.index));
        const auto trace = [&](const auto& target) {
            unseen[i] = 0.0f;
            for (std::uint32_t k = 0; k < samples; ++k) rays.add(i, origin, target(points.point(k)));
            counts.shadow_rays += samples;
        };
        if (disk.places == nullptr) {
            trace(of_disk);
            continue;
        }
        const LitMembers members(disk, receivers, i);
        if (members.any()) trace([&](const vec2& u) { return members.choose(u.x); });
    }
    rays.trace();
    for (int i = 0; i < receivers.count; ++i)
        if (irradiance[i] > 0.0f) visible[i] = 1.0f - unseen[i] / static_cast<float>(samples);
}

}  // namespace interreflect
