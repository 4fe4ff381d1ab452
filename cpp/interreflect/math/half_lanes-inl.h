// Half floats from floats. Included once for every vector target.
#if defined(INTERREFLECT_HALF_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_HALF_LANES
#undef INTERREFLECT_HALF_LANES
#else
#define INTERREFLECT_HALF_LANES
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The nearest half floats, ties to even, as machines with F16C make them. Highway 1.0.3 cuts digits off on SSE4, and the sign of
/// -0.
template <class D>
HWY_INLINE hn::Vec<hn::Rebind<hwy::float16_t, D>> nearest_halves(D d, hn::Vec<D> value) {
    const hn::Rebind<hwy::float16_t, D> half;
#if HWY_TARGET == HWY_SSE4
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint16_t, D> words;
    const auto bits = hn::BitCast(di, value), sign = hn::And(bits, hn::Set(di, INT32_MIN)), size = hn::Xor(bits, sign);
    // Normal: the exponent's bias changes from 127 to 15, and 13 bits of the fraction are rounded away.
    const auto odd = hn::And(hn::ShiftRight<13>(size), hn::Set(di, 1));
    const auto normal = hn::ShiftRight<13>(hn::Add(hn::Add(size, hn::Set(di, 0xFFF - (112 << 23))), odd));
    // Below 2^-14: added to 1/2, whose last digit is worth 2^-24, the sum's rounding is the one wanted.
    const auto magic = hn::BitCast(di, hn::Set(d, 0.5f));
    const auto small = hn::Sub(hn::BitCast(di, hn::Add(hn::BitCast(d, size), hn::Set(d, 0.5f))), magic);
    const auto finite = hn::IfThenElse(hn::Lt(size, hn::Set(di, 113 << 23)), small, normal);
    const auto not_a_number = hn::Gt(size, hn::Set(di, 255 << 23));
    const auto large = hn::IfThenElse(not_a_number, hn::Set(di, 0x7E00), hn::Set(di, 0x7C00));
    const auto rounded = hn::IfThenElse(hn::Lt(size, hn::Set(di, 143 << 23)), finite, large);
    const auto signs = hn::And(hn::ShiftRight<16>(sign), hn::Set(di, 0x8000));
    return hn::BitCast(half, hn::DemoteTo(words, hn::Or(rounded, signs)));
#else
    (void)d;
    return hn::DemoteTo(half, value);
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
