#include "caches/preconvolve/convolve.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/preconvolve/convolve.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/half_lanes-inl.h"

// Roofline, a cache of 16 x 16 and a table of 7 x 7: 85 coarser texels of four finer ones each, and 256 x 224 multiplications and
// additions of the table, 32 a cycle: some 2,500 cycles, 4,096 caches in 2.7 ms on one core.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using HalfTag = hn::Rebind<hwy::float16_t, Tag>;

void to_floats(const std::uint16_t* halves, std::size_t count, float* floats) {
    const Tag d;
    const HalfTag dh;
    const auto* from = reinterpret_cast<const hwy::float16_t*>(halves);
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) hn::StoreU(hn::PromoteTo(d, hn::LoadU(dh, from + i)), d, floats + i);
    for (const hn::CappedTag<float, 4> d4; i < count; i += 4)
        hn::StoreU(hn::PromoteTo(d4, hn::LoadU(hn::Rebind<hwy::float16_t, decltype(d4)>(), from + i)), d4, floats + i);
}

void to_halves(const float* floats, std::size_t count, std::uint16_t* halves) {
    const Tag d;
    const HalfTag dh;
    auto* to = reinterpret_cast<hwy::float16_t*>(halves);
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) hn::StoreU(nearest_halves(d, hn::LoadU(d, floats + i)), dh, to + i);
    for (const hn::CappedTag<float, 4> d4; i < count; i += 4) {
        const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
        hn::StoreU(nearest_halves(d4, hn::LoadU(d4, floats + i)), dh4, to + i);
    }
}

void apply_sparse(const SparseMeans& means, const float* from, float* to) {
    const hn::FixedTag<float, 4> d;
    for (int i = 0; i < means.outputs(); ++i) {
        auto sum = hn::Zero(d);
        for (int k = means.first[i]; k < means.first[i + 1]; ++k) {
            const SparseMeans::Share& share = means.shares[static_cast<std::size_t>(k)];
            sum = hn::MulAdd(hn::LoadU(d, from + 4 * share.texel), hn::Set(d, share.weight), sum);
        }
        hn::StoreU(sum, d, to + 4 * i);
    }
}

/// Four caches at a time, two vectors of outputs each: the weights, which fill the second cache, are read once for all.
void apply_dense(const DenseMeans& means, const float* const from[4], float* const to[4]) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int first = 0; first < means.stride(); first += 2 * lanes) {
        auto a0 = hn::Zero(d), b0 = a0, c0 = a0, e0 = a0, a1 = a0, b1 = a0, c1 = a0, e1 = a0;
        for (int input = 0; input < means.inputs(); ++input) {
            const float* weights = means.weights() + static_cast<std::size_t>(input) * means.stride() + first;
            const auto w0 = hn::LoadU(d, weights), w1 = hn::LoadU(d, weights + lanes);
            const auto a = hn::LoadDup128(d, from[0] + 4 * input), b = hn::LoadDup128(d, from[1] + 4 * input);
            const auto c = hn::LoadDup128(d, from[2] + 4 * input), e = hn::LoadDup128(d, from[3] + 4 * input);
            a0 = hn::MulAdd(a, w0, a0), b0 = hn::MulAdd(b, w0, b0), c0 = hn::MulAdd(c, w0, c0), e0 = hn::MulAdd(e, w0, e0);
            a1 = hn::MulAdd(a, w1, a1), b1 = hn::MulAdd(b, w1, b1), c1 = hn::MulAdd(c, w1, c1), e1 = hn::MulAdd(e, w1, e1);
        }
        hn::StoreU(a0, d, to[0] + first), hn::StoreU(a1, d, to[0] + first + lanes);
        hn::StoreU(b0, d, to[1] + first), hn::StoreU(b1, d, to[1] + first + lanes);
        hn::StoreU(c0, d, to[2] + first), hn::StoreU(c1, d, to[2] + first + lanes);
        hn::StoreU(e0, d, to[3] + first), hn::StoreU(e1, d, to[3] + first + lanes);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(to_floats);
HWY_EXPORT(to_halves);
HWY_EXPORT(apply_sparse);
HWY_EXPORT(apply_dense);

void halves_to_floats(const std::uint16_t* halves, std::size_t count, float* floats) {
    HWY_DYNAMIC_DISPATCH(to_floats)(halves, count, floats);
}
void floats_to_halves(const float* floats, std::size_t count, std::uint16_t* halves) {
    HWY_DYNAMIC_DISPATCH(to_halves)(floats, count, halves);
}
void apply(const SparseMeans& means, const float* from, float* to) { HWY_DYNAMIC_DISPATCH(apply_sparse)(means, from, to); }
void apply(const DenseMeans& means, const float* const from[4], float* const to[4]) {
    HWY_DYNAMIC_DISPATCH(apply_dense)(means, from, to);
}

}  // namespace interreflect
#endif
