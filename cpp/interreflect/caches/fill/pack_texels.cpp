#include "caches/fill/texels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/fill/pack_texels.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/half_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void pack_texels(const float* r, const float* g, const float* b, const float* open, std::size_t count, std::uint16_t* texel) {
    const hn::CappedTag<float, 16> d;
    const hn::Rebind<std::uint16_t, decltype(d)> bits;
    const auto packed = [&](const float* from) HWY_ATTR {
        return hn::BitCast(bits, nearest_halves(d, hn::Min(hn::LoadU(d, from), hn::Set(d, largest_half))));
    };
    for (std::size_t i = 0; i < count; i += hn::Lanes(d))
        hn::StoreInterleaved4(packed(r + i), packed(g + i), packed(b + i), packed(open + i), bits, texel + 4 * i);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(pack_texels);

void pack_texels(const float* r, const float* g, const float* b, const float* open, std::size_t count, std::uint16_t* texel) {
    HWY_DYNAMIC_DISPATCH(pack_texels)(r, g, b, open, count, texel);
}

}  // namespace interreflect
#endif
