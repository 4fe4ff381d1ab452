#include "surfels/evaluate/lobe_sums.h"

#include <algorithm>
#include <utility>

#include "math/spherical_harmonics.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surfels/evaluate/lobe_sums.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/harmonic_lanes-inl.h"

// Pixels side by side lie between the same few caches. Each cache that a vector of pixels uses is taken once for all of them: a
// multiply-add for each of its coefficients that the lobes need, nine a colour for the cosine. Roofline: four caches for sixteen
// pixels take 108 multiply-adds, or 7 a pixel; pixels that share nothing 16 times as many.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t lanes = hn::MaxLanes(Tag());
constexpr int most_coefficients = 3 * most_bands * most_bands;

/// What each coefficient weighs in a vector of lobes, up to the last band that weighs something in one of them.
struct LobeWeights {
    alignas(64) float value[most_bands * most_bands][lanes];
    int count;  // of coefficients

    template <int bands>
    HWY_INLINE void set(const Vec3& axis, Vector exponent) {
        const Tag d;
        Vector scale[bands];
        for (int l = 0; l < bands; ++l) {
            scale[l] = band_scale(l, exponent);
            if (!hn::AllTrue(d, hn::Eq(scale[l], hn::Zero(d)))) count = (l + 1) * (l + 1);
        }
        project<bands>(axis, scale);
    }
    /// Of odd bands the cosine has the second one alone.
    template <int bands>
    HWY_INLINE void set_cosine(const Vec3& axis) {
        constexpr int last = bands > 2 && bands % 2 == 0 ? bands - 1 : bands;
        Vector scale[last];
        for (int l = 0; l < last; ++l) scale[l] = hn::Set(Tag(), lobe_scale(l, 1.0f));
        count = last * last;
        project<last>(axis, scale);
    }

  private:
    template <int bands>
    HWY_INLINE void project(const Vec3& axis, const Vector* scale) {
        const Tag d;
        const auto& norms = detail::harmonic_norms();
        visit_harmonics<bands>(axis, [&](int l, int m, Vector p, Vector cosine, Vector sine) HWY_ATTR {
            const float norm = norms[static_cast<std::size_t>(l)][static_cast<std::size_t>(m)];
            const Vector part = hn::Mul(hn::Mul(hn::Set(d, norm), p), scale[l]);
            hn::Store(hn::Mul(part, cosine), d, value[l * l + l + m]);
            if (m > 0) hn::Store(hn::Mul(part, sine), d, value[l * l + l - m]);
        });
    }

    /// lobe_scale
    static HWY_INLINE Vector band_scale(int l, Vector n) {
        const Tag d;
        const Vector one = hn::Set(d, 1.0f);
        const auto plus = [&](int k) HWY_ATTR { return hn::Add(n, hn::Set(d, static_cast<float>(k))); };
        Vector scale = l % 2 == 0 ? one : hn::Div(plus(1), plus(2));
        for (int k = l % 2 + 2; k <= l; k += 2) scale = hn::Mul(scale, hn::Div(plus(2 - k), plus(1 + k)));
        return scale;
    }
};

/// The coefficients of a cache as floats, without its unit.
HWY_INLINE void load_cache(const LightCaches& caches, std::size_t cache, float* coefficients) {
    const Tag d;
    const hn::Rebind<hwy::float16_t, Tag> half;
    const auto stride = static_cast<std::size_t>(caches.stride());
    const auto* from = reinterpret_cast<const hwy::float16_t*>(caches.coefficients.data()) + cache * stride;
    for (std::size_t i = 0; i < stride; i += lanes) hn::Store(hn::PromoteTo(d, hn::LoadU(half, from + i)), d, coefficients + i);
}

/// Adds up three channels over coefficients [begin, end) of the lobes.
HWY_INLINE void add_channels(const LobeWeights& lobes, const float* const* channel, int begin, int end, Vec3& sum) {
    const Tag d;
    for (int i = begin; i < end; ++i) {
        const Vector weight = hn::Load(d, lobes.value[i]);
        sum.x = hn::MulAdd(hn::Set(d, channel[0][i]), weight, sum.x);
        sum.y = hn::MulAdd(hn::Set(d, channel[1][i]), weight, sum.y);
        sum.z = hn::MulAdd(hn::Set(d, channel[2][i]), weight, sum.z);
    }
}

/// A cache's three channels over the lobes, side by side, as each addition waits for the one before.
HWY_INLINE Vec3 over(const LobeWeights& lobes, const float* coefficients, const LightCaches& caches) {
    const Tag d;
    const float* const channel[3] = {coefficients, coefficients + caches.luma(),
                                     coefficients + caches.luma() + caches.chrominance()};
    const int all = lobes.count, both = std::min(all, caches.chrominance());
    Vec3 sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (both == 9) {  // the cosine's, unrolled: two sums each
        Vec3 other = sum;
        add_channels(lobes, channel, 0, 5, sum);
        add_channels(lobes, channel, 5, 9, other);
        sum = {hn::Add(sum.x, other.x), hn::Add(sum.y, other.y), hn::Add(sum.z, other.z)};
    } else {
        add_channels(lobes, channel, 0, both, sum);
    }
    for (int i = both; i < all; ++i) sum.x = hn::MulAdd(hn::Set(d, coefficients[i]), hn::Load(d, lobes.value[i]), sum.x);
    return sum;
}

/// A vector of pixels' slots, of which each cache is taken once.
class Shared {
  public:
    HWY_INLINE Shared(const NearCaches& near, int at) {
        const Tag d;
        for (int k = 0; k < near.slots; ++k) {
            cache_[k] = hn::Load(Number(), near.cache[k] + at), weight_[k] = hn::Load(d, near.weight[k] + at);
            if (!hn::AllTrue(d, hn::Eq(weight_[k], hn::Zero(d)))) slots_ = k + 1;
        }
        numbers_ = near.cache[0] + at;
    }
    /// Calls take(cache, weights) for each.
    template <class Take>
    HWY_INLINE void for_each(const Take& take) {
        const Tag d;
        for (int k = 0; k < slots_; ++k)
            for (;;) {
                const auto uses = hn::Gt(weight_[k], hn::Zero(d));
                const std::intptr_t first = hn::FindFirstTrue(d, uses);
                if (first < 0) break;
                const std::uint32_t cache = numbers_[k * NearCaches::length + first];
                const auto wanted = hn::Set(Number(), cache);
                const auto same_in = [&](int slot) HWY_ATTR { return hn::RebindMask(d, hn::Eq(cache_[slot], wanted)); };
                if (hn::AllFalse(d, hn::AndNot(same_in(k), uses))) {  // in one cell slots hardly ever share a cache
                    take(cache, weight_[k]);
                    break;
                }
                Vector weight = hn::Zero(d);
                for (int other = k; other < slots_; ++other) {
                    const auto same = same_in(other);
                    weight = hn::Add(weight, hn::IfThenElseZero(same, weight_[other]));
                    weight_[other] = hn::IfThenZeroElse(same, weight_[other]);
                }
                take(cache, weight);
            }
    }

  private:
    using Number = hn::RebindToUnsigned<Tag>;
    hn::Vec<Number> cache_[NearCaches::most_slots];
    Vector weight_[NearCaches::most_slots];
    const std::uint32_t* numbers_;
    int slots_ = 0;
};

/// (Y, Co, Cg) to (R, G, B) where the caches have them; not below 0.
HWY_INLINE Vec3 colour_of(const Vec3& mean, bool ycocg) {
    const Vector zero = hn::Zero(Tag());
    Vec3 colour = mean;
    if (ycocg) {
        const Vector t = hn::Sub(mean.x, mean.z);
        colour = {hn::Add(t, mean.y), hn::Add(mean.x, mean.z), hn::Sub(t, mean.y)};
    }
    return {hn::Max(colour.x, zero), hn::Max(colour.y, zero), hn::Max(colour.z, zero)};
}

/// set_weights(weights, bands, axes, at): those of a vector of lobes; bands: as an integral constant.
template <class SetWeights>
HWY_INLINE void sum_over(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes,
                         const SetWeights& set_weights) {
    const Tag d;
    LobeWeights weights;
    alignas(64) float coefficients[most_coefficients + 2 * lanes];
    for (int at = 0; at < count; at += static_cast<int>(lanes)) {
        Vec3 axis;
        hn::LoadInterleaved3(d, &lobes.axis[at].x, axis.x, axis.y, axis.z);
        [&]<int... less>(std::integer_sequence<int, less...>) {
            ((caches.bands == less + 1 ? set_weights(weights, std::integral_constant<int, less + 1>(), axis, at) : void()), ...);
        }
        (std::make_integer_sequence<int, most_bands>());
        Vec3 mean{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
        Shared(near, at).for_each([&](std::uint32_t cache, Vector weight) HWY_ATTR {
            load_cache(caches, cache, coefficients);
            mean = moved(mean, over(weights, coefficients, caches), hn::Mul(weight, hn::Set(d, caches.unit[cache])));
        });
        store3(colour_of(mean, caches.ycocg), &lobes.mean[at].x);
    }
}

void SumLobes(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes) {
    sum_over(caches, near, count, lobes, [&](LobeWeights& weights, auto bands, const Vec3& axis, int at) HWY_ATTR {
        weights.set<bands()>(axis, hn::Load(Tag(), lobes.exponent + at));
    });
}
void SumCosines(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes) {
    sum_over(caches, near, count, lobes,
             [](LobeWeights& weights, auto bands, const Vec3& axis, int) HWY_ATTR { weights.set_cosine<bands()>(axis); });
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(SumLobes);
HWY_EXPORT(SumCosines);

void sum_lobes(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes) {
    HWY_DYNAMIC_DISPATCH(SumLobes)(caches, near, count, lobes);
}
void sum_cosines(const LightCaches& caches, const NearCaches& near, int count, Lobes& lobes) {
    HWY_DYNAMIC_DISPATCH(SumCosines)(caches, near, count, lobes);
}
}  // namespace interreflect
#endif
