#include "caches/preconvolve/convolve.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/preconvolve/convolve.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

// Roofline, a cache of 16 x 16 and a table of 7 x 7: 85 coarser texels of four finer ones each, and 64 x 196 multiplications and
// additions of the table, 32 a cycle: some 1,500 cycles, 4,096 caches in 1.6 ms on one core.
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
    for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) hn::StoreU(hn::DemoteTo(dh, hn::LoadU(d, floats + i)), dh, to + i);
    for (const hn::CappedTag<float, 4> d4; i < count; i += 4) {
        const hn::Rebind<hwy::float16_t, decltype(d4)> dh4;
        hn::StoreU(hn::DemoteTo(dh4, hn::LoadU(d4, floats + i)), dh4, to + i);
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

void apply_dense(const DenseMeans& means, const float* from, float* to) {
    const Tag d;
    constexpr int together = 8;
    const int lanes = static_cast<int>(hn::Lanes(d));
    static_assert(DenseMeans::group % (together * hn::MaxLanes(d)) == 0);
    for (int first = 0; first < means.stride(); first += together * lanes) {
        auto a = hn::Zero(d), b = a, c = a, e = a, f = a, g = a, h = a, i = a;
        for (int input = 0; input < means.inputs(); ++input) {
            const auto texel = hn::LoadDup128(d, from + 4 * input);
            const float* w = means.weights() + static_cast<std::size_t>(input) * means.stride() + first;
            a = hn::MulAdd(texel, hn::LoadU(d, w), a), b = hn::MulAdd(texel, hn::LoadU(d, w + lanes), b);
            c = hn::MulAdd(texel, hn::LoadU(d, w + 2 * lanes), c), e = hn::MulAdd(texel, hn::LoadU(d, w + 3 * lanes), e);
            f = hn::MulAdd(texel, hn::LoadU(d, w + 4 * lanes), f), g = hn::MulAdd(texel, hn::LoadU(d, w + 5 * lanes), g);
            h = hn::MulAdd(texel, hn::LoadU(d, w + 6 * lanes), h), i = hn::MulAdd(texel, hn::LoadU(d, w + 7 * lanes), i);
        }
        float* out = to + first;
        hn::StoreU(a, d, out), hn::StoreU(b, d, out + lanes), hn::StoreU(c, d, out + 2 * lanes);
        hn::StoreU(e, d, out + 3 * lanes), hn::StoreU(f, d, out + 4 * lanes), hn::StoreU(g, d, out + 5 * lanes);
        hn::StoreU(h, d, out + 6 * lanes), hn::StoreU(i, d, out + 7 * lanes);
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
void apply(const DenseMeans& means, const float* from, float* to) { HWY_DYNAMIC_DISPATCH(apply_dense)(means, from, to); }

}  // namespace interreflect
#endif
