// Look-ups in hemisphere maps for vectors of lanes. Included once for every vector target.
#if defined(INTERREFLECT_MAP_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_MAP_LANES
#undef INTERREFLECT_MAP_LANES
#else
#define INTERREFLECT_MAP_LANES
#endif

#include <algorithm>
#include <cstring>

#include "math/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Indices = hn::Vec<hn::RebindToSigned<Tag>>;

struct Square {
    Vector x, y;
};

/// hemisphere_square of hemisphere_map.h. 4 / pi times the arctangent on [0, 1] as a polynomial, off by 3.2e-7 at most.
HWY_INLINE Square hemisphere_square_lanes(const Vec3& direction) {
    const Tag d;
    const auto number = [d](float value) HWY_ATTR { return hn::Set(d, value); };
    const Vector zero = hn::Zero(d), half = number(0.5f), x = hn::Abs(direction.x), y = hn::Abs(direction.y);
    const Vector larger = hn::Max(x, y), smaller = hn::Min(x, y);
    const Vector t = hn::Div(smaller, hn::Max(larger, number(1e-30f))), t2 = hn::Mul(t, t);
    Vector turn = hn::MulAdd(number(0.008673040f), t2, number(-0.042786207f));
    for (const float factor : {0.101379990f, -0.168492134f, 0.252200938f, -0.424209905f, 1.273234594f})
        turn = hn::MulAdd(turn, t2, number(factor));
    const Vector down = hn::Max(hn::Sub(number(1.0f), direction.z), zero);
    const Vector radius = hn::Mul(half, hn::Sqrt(hn::Min(down, number(1.0f)))), across = hn::Mul(hn::Mul(turn, t), radius);
    const auto wide = hn::Ge(x, y);
    const Vector px = hn::IfThenElse(wide, radius, across), py = hn::IfThenElse(wide, across, radius);
    return {hn::Add(hn::CopySign(px, direction.x), half), hn::Add(hn::CopySign(py, direction.y), half)};
}

/// Bilinear between the centres of an n x n map: the upper left texel, its neighbours, and the weights of the four.
struct Corners {
    Indices first;
    int right, below;
    Vector weight[4];

    HWY_INLINE Corners(Vector sx, Vector sy, int n, Vector times) : right(n > 1 ? 1 : 0), below(n > 1 ? n : 0) {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const Vector size = hn::Set(d, static_cast<float>(n)), last = hn::Set(d, static_cast<float>(n - 1));
        const Indices most = hn::Set(di, std::max(n - 2, 0));
        const auto place = [&](Vector s)
                               HWY_ATTR { return hn::Min(hn::Max(hn::MulAdd(s, size, hn::Set(d, -0.5f)), hn::Zero(d)), last); };
        const Vector px = place(sx), py = place(sy);
        const Indices x = hn::Min(hn::ConvertTo(di, px), most), y = hn::Min(hn::ConvertTo(di, py), most);
        const Vector fx = hn::Sub(px, hn::ConvertTo(d, x)), fy = hn::Mul(hn::Sub(py, hn::ConvertTo(d, y)), times);
        first = hn::Add(hn::Mul(y, hn::Set(di, n)), x);
        weight[3] = hn::Mul(fx, fy);
        weight[2] = hn::Sub(fy, weight[3]);
        weight[1] = hn::NegMulAdd(fx, fy, hn::Mul(fx, times));
        weight[0] = hn::Sub(hn::Sub(times, fy), weight[1]);
    }
    HWY_INLINE int offset(int corner) const { return (corner & 1) * right + (corner >> 1) * below; }
};

/// Texels where they are, one load each: gathers of halves take twice as long.
struct TexelsInMemory {
    const std::uint16_t* texels;

    explicit HWY_INLINE TexelsInMemory(const std::uint16_t* from, int) : texels(from) {}
    HWY_INLINE void add(const Corners& at, Vector sum[4]) const {
        const Tag d;
        const hn::FixedTag<float, 4> d4;
        const hn::Rebind<hwy::float16_t, decltype(d4)> df16;
        const hn::RebindToSigned<Tag> di;
        constexpr int most = hn::MaxLanes(d);
        alignas(64) std::int32_t first[most];
        alignas(64) float weight[4][most], mean[4 * most];
        hn::Store(at.first, di, first);
        for (int corner = 0; corner < 4; ++corner) hn::Store(at.weight[corner], d, weight[corner]);
        const int right = 4 * at.offset(1), below = 4 * at.offset(2);
        for (int i = 0; i < most; ++i) {
            const auto* from = reinterpret_cast<const hwy::float16_t*>(texels + 4 * first[i]);
            const auto texel = [&](int offset) HWY_ATTR { return hn::PromoteTo(d4, hn::LoadU(df16, from + offset)); };
            auto here = hn::Mul(hn::Set(d4, weight[0][i]), texel(0));
            here = hn::MulAdd(hn::Set(d4, weight[1][i]), texel(right), here);
            here = hn::MulAdd(hn::Set(d4, weight[2][i]), texel(below), here);
            hn::Store(hn::MulAdd(hn::Set(d4, weight[3][i]), texel(below + right), here), d4, mean + 4 * i);
        }
        Vector r, g, b, a;
        hn::LoadInterleaved4(d, mean, r, g, b, a);
        sum[0] = hn::Add(sum[0], r), sum[1] = hn::Add(sum[1], g), sum[2] = hn::Add(sum[2], b), sum[3] = hn::Add(sum[3], a);
    }
};

#if HWY_TARGET <= HWY_AVX3
/// A few texels in a place of their own, from which whole vectors can be loaded.
struct TexelCopy {
    alignas(64) std::uint16_t halves[4 * 64];

    HWY_INLINE TexelCopy(const std::uint16_t* texels, int count) {
        std::memcpy(halves, texels, 4 * sizeof(std::uint16_t) * static_cast<std::size_t>(count));
    }
};

/// Up to 32 texels in registers.
struct FloatRegisters {
    Vector lower[4], upper[4];

    HWY_INLINE FloatRegisters(const std::uint16_t* texels, int count) {
        const Tag d;
        const hn::Rebind<std::uint16_t, Tag> half;
        const hn::Rebind<hwy::float16_t, Tag> df16;
        const TexelCopy copy(texels, count);
        const auto load = [&](const std::uint16_t* from, Vector to[4]) HWY_ATTR {
            hn::Vec<decltype(half)> r, g, b, a;
            hn::LoadInterleaved4(half, from, r, g, b, a);
            to[0] = hn::PromoteTo(d, hn::BitCast(df16, r)), to[1] = hn::PromoteTo(d, hn::BitCast(df16, g));
            to[2] = hn::PromoteTo(d, hn::BitCast(df16, b)), to[3] = hn::PromoteTo(d, hn::BitCast(df16, a));
        };
        load(copy.halves, lower);
        load(copy.halves + 4 * 16, upper);
    }
    HWY_INLINE void add(const Corners& at, Vector sum[4]) const {
        const hn::RebindToSigned<Tag> di;
        for (int corner = 0; corner < 4; ++corner) {
            const __m512i from = hn::Add(at.first, hn::Set(di, at.offset(corner))).raw;
            for (int k = 0; k < 4; ++k) {
                const Vector texel{_mm512_permutex2var_ps(lower[k].raw, from, upper[k].raw)};
                sum[k] = hn::MulAdd(at.weight[corner], texel, sum[k]);
            }
        }
    }
};

/// Up to 64 texels in registers, as halves: left and right neighbours of all lanes in one permutation.
struct HalfRegisters {
    __m512i lower[4], upper[4];

    HWY_INLINE HalfRegisters(const std::uint16_t* texels, int count) {
        const hn::Repartition<std::uint16_t, Tag> du16;
        const TexelCopy copy(texels, count);
        const auto load = [&](const std::uint16_t* from, __m512i to[4]) HWY_ATTR {
            hn::Vec<decltype(du16)> r, g, b, a;
            hn::LoadInterleaved4(du16, from, r, g, b, a);
            to[0] = r.raw, to[1] = g.raw, to[2] = b.raw, to[3] = a.raw;
        };
        load(copy.halves, lower);
        load(copy.halves + 4 * 32, upper);
    }
    HWY_INLINE void add(const Corners& at, Vector sum[4]) const {
        const Tag d;
        const hn::Repartition<std::uint16_t, Tag> du16;
        const hn::Half<decltype(du16)> half;
        const hn::Rebind<hwy::float16_t, Tag> df16;
        const auto first = hn::TruncateTo(half, hn::BitCast(hn::RebindToUnsigned<Tag>(), at.first));
        const auto moved = [&](int corner)
                               HWY_ATTR { return hn::Add(first, hn::Set(half, static_cast<std::uint16_t>(at.offset(corner)))); };
        for (int row = 0; row < 4; row += 2) {
            const auto from = hn::Combine(du16, moved(row + 1), moved(row));
            for (int k = 0; k < 4; ++k) {
                const hn::Vec<decltype(du16)> texels{_mm512_permutex2var_epi16(lower[k], from.raw, upper[k])};
                const Vector left = hn::PromoteTo(d, hn::BitCast(df16, hn::LowerHalf(half, texels)));
                const Vector right = hn::PromoteTo(d, hn::BitCast(df16, hn::UpperHalf(half, texels)));
                sum[k] = hn::MulAdd(at.weight[row + 1], right, hn::MulAdd(at.weight[row], left, sum[k]));
            }
        }
    }
};
#endif

/// Calls body with the texels of an n x n map as this target reads them fastest.
template <class Body>
HWY_INLINE void with_texels(const std::uint16_t* texels, int n, const Body& body) {
#if HWY_TARGET <= HWY_AVX3
    if (n * n <= 32) return body(FloatRegisters(texels, n * n));
    if (n * n <= 64) return body(HalfRegisters(texels, n * n));
#endif
    body(TexelsInMemory(texels, n * n));
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
