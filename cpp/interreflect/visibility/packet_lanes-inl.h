// Sixteen lanes of a ray packet: sets of them as bits. Included once for every vector target.
#if defined(INTERREFLECT_PACKET_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_PACKET_LANES
#undef INTERREFLECT_PACKET_LANES
#else
#define INTERREFLECT_PACKET_LANES
#endif

#include "math/lanes-inl.h"
#include "visibility/intersector.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int packet = RayPacket::width;
inline constexpr std::uint32_t all_lanes = (1U << packet) - 1;
using FloatLanes = float[packet];

/// Lanes k and following of a set of lanes.
HWY_INLINE LaneMask mask_from(std::uint32_t lanes, int k) {
    const std::uint64_t bits = lanes >> k;
    std::uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof(bytes));
    return hn::LoadMaskBits(Tag(), bytes);
}

/// The lanes that hold `value`.
HWY_INLINE std::uint32_t lanes_equal(const std::uint32_t* numbers, std::uint32_t value) {
    const hn::RebindToUnsigned<Tag> du;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
    std::uint32_t equal = 0;
    for (int k = 0; k < packet; k += lanes) {
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(du, hn::Eq(hn::Load(du, numbers + k), hn::Set(du, value)), bytes);
        std::uint32_t bits;
        std::memcpy(&bits, bytes, sizeof(bits));
        equal |= (bits & ((1U << lanes) - 1)) << k;
    }
    return equal;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
