#include "voxels/voxelize/unseen.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/voxelize/unseen.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "voxels/voxelize/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

/// Whether a sample at `place` of any pixel lies in [least, most].
HWY_INLINE LaneMask holds_sample(Vector least, Vector most, float place) {
    const Vector at = hn::Set(Tag(), place);
    return hn::Le(hn::Ceil(hn::Sub(least, at)), hn::Sub(most, at));
}

std::uint32_t unseen_lanes(const TrianglePacket& packet, const vec2* samples, int count, float scale) {
    const Tag d;
    // Pixels: far more than an edge's crossings are rounded by.
    const Vector slack = hn::Set(d, 1e-3f), pixels = hn::Set(d, scale);
    // Two axes alike: rounding decides elsewhere which is the dominant one.
    const Vector most_alike = hn::Set(d, 1.0f + 1e-5f);
    std::uint32_t unseen = 0;
    for (int k = 0; k < TrianglePacket::width; k += static_cast<int>(hn::Lanes(d))) {
        const Vec3 corner[3] = {load_axes(packet.corner[0], k), load_axes(packet.corner[1], k), load_axes(packet.corner[2], k)};
        const Vec3 low = lowest(corner), high = highest(corner), cross = load_axes(packet.cross, k);
        const Vector x = hn::Abs(cross.x), y = hn::Abs(cross.y), z = hn::Abs(cross.z);
        const LaneMask along_x = hn::Gt(x, hn::Mul(most_alike, hn::Max(y, z))),
                       along_y = hn::Gt(y, hn::Mul(most_alike, hn::Max(x, z))),
                       along_z = hn::Gt(z, hn::Mul(most_alike, hn::Max(x, y)));
        const auto across = [&](Vector of_x, Vector of_y, Vector of_z) HWY_ATTR {
            return hn::Mul(hn::IfThenElse(along_x, of_x, hn::IfThenElse(along_y, of_y, of_z)), pixels);
        };
        const Vector least_u = hn::Sub(across(low.y, low.z, low.x), slack),
                     most_u = hn::Add(across(high.y, high.z, high.x), slack);
        const Vector least_v = hn::Sub(across(low.z, low.x, low.y), slack),
                     most_v = hn::Add(across(high.z, high.x, high.y), slack);
        LaneMask seen = hn::Not(hn::Or(hn::Or(along_x, along_y), along_z));
        for (int i = 0; i < count; ++i)
            seen =
                hn::Or(seen, hn::And(holds_sample(least_u, most_u, samples[i].x), holds_sample(least_v, most_v, samples[i].y)));
        unseen |= bits_of(hn::Not(seen)) << k;
    }
    return unseen;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(unseen_lanes);

Unseen::Unseen(std::span<const vec2> samples, int oversampling)
    : count_(static_cast<int>(samples.size())), scale_(static_cast<float>(oversampling)) {
    std::copy(samples.begin(), samples.end(), samples_.begin());
}

std::uint32_t Unseen::of(const TrianglePacket& packet) const {
    return HWY_DYNAMIC_DISPATCH(unseen_lanes)(packet, samples_.data(), count_, scale_);
}
}  // namespace interreflect
#endif
