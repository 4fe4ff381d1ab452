// How much of a cone a step blocks. Included once for every vector target.
#if defined(INTERREFLECT_OPACITY_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_OPACITY_KERNEL
#undef INTERREFLECT_OPACITY_KERNEL
#else
#define INTERREFLECT_OPACITY_KERNEL
#endif

#include "voxels/march/march_cones.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The coordinate whose number is `axis`, lane by lane.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V of_axis(D d, V axis, V x, V y, V z) {
    return hn::IfThenElse(hn::Lt(axis, hn::Set(d, 0.5f)), x, hn::IfThenElse(hn::Lt(axis, hn::Set(d, 1.5f)), y, z));
}

/// Integral of the tent of the trilinear filter from -infinity to x (texels).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V tent_integral(D d, V x) {
    const V one = hn::Set(d, 1.0f), half = hn::Set(d, 0.5f);
    const V t = hn::Min(hn::Max(x, hn::Set(d, -1.0f)), one);
    const V rise = hn::Sub(one, hn::Abs(t));
    const V tail = hn::Mul(half, hn::Mul(rise, rise));
    return hn::IfThenElse(hn::Lt(t, hn::Zero(d)), tail, hn::Sub(one, tail));
}

/// What the receiver's own plane adds to a level's filtered opacity at a sample: its voxels are a layer `width` texels thick.
/// `scale`: texels a voxel.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V own_opacity(D d, V scale, V height, V width, V axis_plane, V axis_sample, V axis_cells, V aligned) {
    const V half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const V h = hn::Mul(height, scale), reach = hn::Mul(width, half);
    const V mean = hn::Sub(tent_integral(d, hn::Add(h, reach)), tent_integral(d, hn::Sub(h, reach)));
    const V centre = hn::Add(hn::Floor(hn::Mul(axis_plane, scale)), half);
    // The border repeats the outermost texels: beyond their centres nothing changes.
    const V last = hn::Sub(hn::Ceil(hn::Mul(axis_cells, scale)), half);
    const V sample = hn::Min(hn::Max(hn::Mul(axis_sample, scale), half), last);
    const V known = hn::Max(hn::Sub(one, hn::Abs(hn::Sub(sample, centre))), zero);
    return hn::IfThenElse(hn::Gt(aligned, zero), known, mean);
}

/// Estrin's scheme, highest power first: cones wait for it, step after step.
template <class D, class V = hn::Vec<D>, std::size_t n>
HWY_INLINE V polynomial(D d, V x, const float (&coefficients)[n]) {
    V terms[(n + 1) / 2];
    const auto of = [&](std::size_t power) HWY_ATTR { return hn::Set(d, coefficients[n - 1 - power]); };
    for (std::size_t i = 0; i < n / 2; ++i) terms[i] = hn::MulAdd(of(2 * i + 1), x, of(2 * i));
    if constexpr (n % 2 == 1) terms[n / 2] = of(n - 1);
    V power = hn::Mul(x, x);
    for (std::size_t left = (n + 1) / 2; left > 1; left = (left + 1) / 2, power = hn::Mul(power, power)) {
        for (std::size_t i = 0; i < left / 2; ++i) terms[i] = hn::MulAdd(terms[2 * i + 1], power, terms[2 * i]);
        if (left % 2 == 1) terms[left / 2] = terms[left - 1];
    }
    return terms[0];
}

/// log2(x), x > 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V log2_of(D d, V x) {
    const hn::RebindToSigned<D> di;
    // Chebyshev fit of log2(1 + t) / t for 1 + t in [sqrt(1/2), sqrt(2)].
    static constexpr float log2_over_t[] = {0.172128703f, -0.269506265f, 0.295633603f, -0.359350654f,
                                            0.480629147f, -0.72136404f,  1.44269643f};
    const auto bits = hn::BitCast(di, x);
    const auto whole = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));  // sqrt(1/2)
    const V t = hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(whole))), hn::Set(d, 1.0f));
    return hn::MulAdd(t, polynomial(d, t, log2_over_t), hn::ConvertTo(d, whole));
}

/// 2^y, y in [-126, 126].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_of(D d, V y) {
    const hn::RebindToSigned<D> di;
    // Chebyshev fit of 2^t for t in [-1/2, 1/2].
    static constexpr float exp2_of_t[] = {0.00134004322f, 0.0096760371f, 0.0555032721f, 0.240221074f, 0.693147207f, 1.0f};
    const V nearest = hn::Round(y), mantissa = polynomial(d, hn::Sub(y, nearest), exp2_of_t);
    return hn::BitCast(d, hn::Add(hn::BitCast(di, mantissa), hn::ShiftLeft<23>(hn::ConvertTo(di, nearest))));
}

/// x^exponent, x in [0, 1], within 1e-6 times the exponent: opacities are half floats. Exactly 1 at 1, and 0 from 1e-12 down.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V power(D d, V x, V exponent) {
    const V y = hn::Max(hn::Mul(log2_of(d, x), exponent), hn::Set(d, -126.0f));
    return hn::IfThenElseZero(hn::Gt(x, hn::Set(d, 1e-12f)), exp2_of(d, y));
}

/// 1 - (1 - a)^exponent.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V stretched_opacity(D d, V a, float exponent) {
    const V one = hn::Set(d, 1.0f);
    if (exponent == 1.0f) return a;
    const V clear = hn::Sub(one, a);
    if (exponent == 0.5f) return hn::Sub(one, hn::Sqrt(clear));
    if (exponent == 2.0f) return hn::Sub(one, hn::Mul(clear, clear));
    return hn::Sub(one, power(d, clear, hn::Set(d, exponent)));
}

/// How much of the cone a step newly blocks. Independent of what blocked it before, it is the step's share of what is open; fully
/// correlated (a wall along the cone covers the same part of it at every step), only what exceeds all that is blocked already.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V newly_blocked(D d, V open, V opacity, float correlation) {
    const V independent = hn::Mul(open, opacity);
    if (correlation == 0.0f) return independent;
    const V beyond = hn::Max(hn::Sub(hn::Add(open, opacity), hn::Set(d, 1.0f)), hn::Zero(d));
    return hn::MulAdd(hn::Sub(beyond, independent), hn::Set(d, correlation), independent);
}

/// From the sum of distances, weighted by what was blocked there, to their mean.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V mean_depth(D d, V sum, V open) {
    const V one = hn::Set(d, 1.0f);
    const auto any = hn::Lt(open, one);
    return hn::IfThenElse(any, hn::Div(sum, hn::IfThenElse(any, hn::Sub(one, open), one)), hn::Set(d, nothing_there));
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();
#endif
