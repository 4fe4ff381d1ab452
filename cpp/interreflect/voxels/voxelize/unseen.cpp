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

/// Triangles on the grid of pixels.
struct FlatLanes {
    Vector u[3], v[3], turn;  // corners; 1, or -1 where they run clockwise

    /// Whether a place lies beyond an edge by more than `slack` pixels.
    HWY_INLINE LaneMask misses(Vector at_u, Vector at_v, Vector slack) const {
        LaneMask outside = hn::Ne(turn, turn);
        for (int i = 0; i < 3; ++i) {
            const Vector along_u = hn::Sub(u[(i + 1) % 3], u[i]), along_v = hn::Sub(v[(i + 1) % 3], v[i]);
            const Vector side = hn::Sub(hn::Mul(along_u, hn::Sub(at_v, v[i])), hn::Mul(along_v, hn::Sub(at_u, u[i])));
            const Vector least = hn::Mul(slack, hn::Add(hn::Abs(along_u), hn::Abs(along_v)));
            outside = hn::Or(outside, hn::Lt(hn::Mul(turn, side), hn::Neg(least)));
        }
        return outside;
    }
};

/// The samples at one place in every pixel that may lie in [least, most]: the first one, and whether there are others.
struct CandidateLanes {
    Vector first;
    LaneMask any, others;

    HWY_INLINE CandidateLanes(Vector least, Vector most, float place) {
        const Tag d;
        const Vector at = hn::Set(d, place);
        first = hn::Add(hn::Ceil(hn::Sub(least, at)), at);
        any = hn::Le(first, most);
        others = hn::Le(hn::Add(first, hn::Set(d, 1.0f)), most);
    }
};

std::uint32_t unseen_lanes(const TrianglePacket& packet, const vec2* samples, int count, float scale) {
    const Tag d;
    // Pixels: far more than an edge's crossings are rounded by.
    const Vector slack = hn::Set(d, 1e-3f), pixels = hn::Set(d, scale);
    // Two axes alike: rounding decides elsewhere which is the dominant one.
    const Vector most_alike = hn::Set(d, 1.0f + 1e-5f);
    std::uint32_t unseen = 0;
    for (int k = 0; k < TrianglePacket::width; k += static_cast<int>(hn::Lanes(d))) {
        const Vec3 cross = load_axes(packet.cross, k);
        const Vector x = hn::Abs(cross.x), y = hn::Abs(cross.y), z = hn::Abs(cross.z);
        const LaneMask along_x = hn::Gt(x, hn::Mul(most_alike, hn::Max(y, z))),
                       along_y = hn::Gt(y, hn::Mul(most_alike, hn::Max(x, z))),
                       along_z = hn::Gt(z, hn::Mul(most_alike, hn::Max(x, y)));
        const auto across = [&](Vector of_x, Vector of_y, Vector of_z)
                                HWY_ATTR { return hn::IfThenElse(along_x, of_x, hn::IfThenElse(along_y, of_y, of_z)); };
        FlatLanes flat;
        for (int i = 0; i < 3; ++i) {
            const Vec3 corner = load_axes(packet.corner[i], k);
            flat.u[i] = hn::Mul(across(corner.y, corner.z, corner.x), pixels);
            flat.v[i] = hn::Mul(across(corner.z, corner.x, corner.y), pixels);
        }
        flat.turn = hn::CopySign(hn::Set(d, 1.0f), across(cross.x, cross.y, cross.z));
        const auto least = [&](const Vector* of) HWY_ATTR { return hn::Sub(hn::Min(hn::Min(of[0], of[1]), of[2]), slack); };
        const auto most = [&](const Vector* of) HWY_ATTR { return hn::Add(hn::Max(hn::Max(of[0], of[1]), of[2]), slack); };
        const Vector least_u = least(flat.u), most_u = most(flat.u), least_v = least(flat.v), most_v = most(flat.v);
        LaneMask seen = hn::Not(hn::Or(hn::Or(along_x, along_y), along_z));
        for (int i = 0; i < count; ++i) {
            const CandidateLanes u(least_u, most_u, samples[i].x), v(least_v, most_v, samples[i].y);
            const LaneMask missed = hn::AndNot(hn::Or(u.others, v.others), flat.misses(u.first, v.first, slack));
            seen = hn::Or(seen, hn::AndNot(missed, hn::And(u.any, v.any)));
        }
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
