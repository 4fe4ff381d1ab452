// Trilinear look-ups of sRGB textures, one lane a look-up. Included once for every vector target.
#if defined(INTERREFLECT_TEXTURE_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_TEXTURE_KERNEL
#undef INTERREFLECT_TEXTURE_KERNEL
#else
#define INTERREFLECT_TEXTURE_KERNEL
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "visibility/kernel_material.h"
#include "visibility/packet_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Rgb {
    V r, g, b;
};

/// A coordinate wrapped into [0, 1).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V wrap_lanes(D d, V x) {
    const V f = hn::Sub(x, hn::Floor(x));
    return hn::IfThenElseZero(hn::Lt(f, hn::Set(d, 1.0f)), f);
}

/// An sRGB byte's linear value. The polynomial is a minimax fit to the 245 values of the curved part, off by at most 2.1e-5;
/// eight bits themselves are off by up to 4e-3.
template <class D, class VI, class V = hn::Vec<D>>
HWY_INLINE V decode_byte(D d, VI byte) {
    const V s = hn::Mul(hn::ConvertTo(d, byte), hn::Set(d, 1.0f / 255.0f));
    V p = hn::Set(d, 0.11869155615568161f);
    p = hn::MulAdd(p, s, hn::Set(d, -0.46439647674560547f));
    p = hn::MulAdd(p, s, hn::Set(d, 0.7862300276756287f));
    p = hn::MulAdd(p, s, hn::Set(d, -0.8190374970436096f));
    p = hn::MulAdd(p, s, hn::Set(d, 0.8569532632827759f));
    p = hn::MulAdd(p, s, hn::Set(d, 0.4853951036930084f));
    p = hn::MulAdd(p, s, hn::Set(d, 0.035330839455127716f));
    p = hn::MulAdd(p, s, hn::Set(d, 0.0008535669767297804f));
    return hn::IfThenElse(hn::Le(s, hn::Set(d, 0.04045f)), hn::Mul(s, hn::Set(d, 1.0f / 12.92f)), p);
}

/// Adds weight times some texels.
template <class D, class VI, class V = hn::Vec<D>>
HWY_INLINE void add_texels(D d, VI texel, V weight, Rgb<V>& sum) {
    const auto byte = hn::Set(hn::RebindToSigned<D>(), 255);
    sum.r = hn::MulAdd(weight, decode_byte(d, hn::And(texel, byte)), sum.r);
    sum.g = hn::MulAdd(weight, decode_byte(d, hn::And(hn::ShiftRight<8>(texel), byte)), sum.g);
    sum.b = hn::MulAdd(weight, decode_byte(d, hn::And(hn::ShiftRight<16>(texel), byte)), sum.b);
}

/// Where the trilinear look-ups of a packet's lanes lie. Rows of texels: lower and upper of the finer level, then of the coarser.
struct TexelPlaces {
    static constexpr int rows = 4;
    alignas(64) std::int32_t left[rows][packet];  // number of the left texel within all levels
    alignas(64) std::int32_t step[2][packet];     // from it to the right one: 1 but at the border of the level
    alignas(64) FloatLanes across[2], up[2], blend;
    alignas(64) std::uint64_t texels[rows][packet];  // left and right one
    std::uint32_t textured;                          // lanes
    bool blended;                                    // whether any lane needs its coarser level
    bool wrapped;                                    // whether any step is not 1
};

/// Left texels and steps of one level, `which` 0 for the finer, of the lanes in `mine`; the other ones' are untouched.
template <class Numbers>
HWY_INLINE void place_level(int which, int k, LaneMask mine, Numbers width, Numbers height, Numbers first, Vector u, Vector v,
                            TexelPlaces& places) {
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    const auto lanes = hn::RebindMask(di, mine);
    const Vector half = hn::Set(d, 0.5f);
    const Vector x = hn::Sub(hn::Mul(u, hn::ConvertTo(d, width)), half), y = hn::Sub(hn::Mul(v, hn::ConvertTo(d, height)), half);
    const Vector fx = hn::Floor(x), fy = hn::Floor(y);
    const auto one = hn::Set(di, 1), zero = hn::Zero(di);
    auto x0 = hn::ConvertTo(di, fx), y0 = hn::ConvertTo(di, fy);
    auto x1 = hn::Add(x0, one), y1 = hn::Add(y0, one);
    x0 = hn::IfThenElse(hn::Lt(x0, zero), hn::Add(x0, width), x0);
    y0 = hn::IfThenElse(hn::Lt(y0, zero), hn::Add(y0, height), y0);
    x1 = hn::IfThenElse(hn::Lt(x1, width), x1, hn::Sub(x1, width));
    y1 = hn::IfThenElse(hn::Lt(y1, height), y1, hn::Sub(y1, height));
    const auto column = hn::Add(first, x0), step = hn::Sub(x1, x0);
    hn::BlendedStore(hn::Add(hn::Mul(y0, width), column), lanes, di, places.left[2 * which] + k);
    hn::BlendedStore(hn::Add(hn::Mul(y1, width), column), lanes, di, places.left[2 * which + 1] + k);
    hn::BlendedStore(step, lanes, di, places.step[which] + k);
    hn::BlendedStore(hn::Sub(x, fx), mine, d, places.across[which] + k);
    hn::BlendedStore(hn::Sub(y, fy), mine, d, places.up[which] + k);
    places.wrapped |= !hn::AllFalse(di, hn::AndNot(hn::Eq(step, one), lanes));
}

/// As Texture::filtered; `area`: the footprint's, in texture coordinates. Only the lanes in `mine` have this material.
HWY_INLINE void place_texels(const KernelMaterial& material, int k, LaneMask mine, Vector u, Vector v, Vector area,
                             TexelPlaces& places) {
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    const auto one = hn::Set(di, 1);
    const float finest = static_cast<float>(material.levels[0].width) * static_cast<float>(material.levels[0].height);
    const Vector texels = hn::Max(hn::Mul(hn::IfThenElseZero(mine, area), hn::Set(d, finest)), hn::Set(d, 1.0f));
    const Vector last = hn::Set(d, static_cast<float>(material.level_count - 1));
    const Vector level = hn::Min(hn::Mul(hn::Set(d, 0.5f), hn::Log2(d, texels)), last), floor = hn::Floor(level);
    const Vector blend = hn::Sub(level, floor);
    hn::BlendedStore(blend, mine, d, places.blend + k);
    places.blended |= !hn::AllTrue(d, hn::Eq(blend, hn::Zero(d)));
    u = wrap_lanes(d, hn::IfThenElseZero(mine, u));
    v = wrap_lanes(d, hn::IfThenElseZero(mine, v));
    // Sides are halved from level to level, rounded down.
    const auto fine = hn::ConvertTo(di, floor);
    const auto width = hn::Max(hn::Shr(hn::Set(di, material.levels[0].width), fine), one);
    const auto height = hn::Max(hn::Shr(hn::Set(di, material.levels[0].height), fine), one);
    const auto* table = reinterpret_cast<const std::int32_t*>(material.levels);
    const auto first = hn::GatherIndex(di, table + 2, hn::Add(hn::Add(fine, fine), fine));
    place_level(0, k, mine, width, height, first, u, v, places);
    // In the last level nothing is blended: its coarser one is itself.
    const auto is_last = hn::Eq(fine, hn::Set(di, material.level_count - 1));
    place_level(1, k, mine, hn::IfThenElse(is_last, width, hn::Max(hn::ShiftRight<1>(width), one)),
                hn::IfThenElse(is_last, height, hn::Max(hn::ShiftRight<1>(height), one)),
                hn::IfThenElse(is_last, first, hn::Add(hn::Mul(width, height), first)), u, v, places);
}

/// Left and right texels of the lanes [begin, end), read as one where they are neighbours.
HWY_INLINE void read_texels(const std::uint32_t* texels, int begin, int end, TexelPlaces& places) {
    const int rows = places.blended ? 4 : 2;
    for (int row = 0; row < rows; ++row)
        for (int k = begin; k < end; ++k) {
            const std::uint32_t* left = texels + places.left[row][k];
            if (!places.wrapped)
                std::memcpy(&places.texels[row][k], left, sizeof(std::uint64_t));
            else
                places.texels[row][k] = *left | static_cast<std::uint64_t>(left[places.step[row / 2][k]]) << 32;
        }
}

/// Adds the bilinear look-ups in one level, `which` 0 for the finer.
HWY_INLINE void add_bilinear(const TexelPlaces& places, int which, int k, Vector weight, Rgb<Vector>& sum) {
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    const Vector across = hn::Load(d, places.across[which] + k);
    const Vector upper = hn::Mul(weight, hn::Load(d, places.up[which] + k)), lower = hn::Sub(weight, upper);
    const Vector upper_right = hn::Mul(upper, across), lower_right = hn::Mul(lower, across);
    hn::Vec<hn::RebindToSigned<Tag>> left, right;
    hn::LoadInterleaved2(di, reinterpret_cast<const std::int32_t*>(places.texels[2 * which] + k), left, right);
    add_texels(d, left, hn::Sub(lower, lower_right), sum);
    add_texels(d, right, lower_right, sum);
    hn::LoadInterleaved2(di, reinterpret_cast<const std::int32_t*>(places.texels[2 * which + 1] + k), left, right);
    add_texels(d, left, hn::Sub(upper, upper_right), sum);
    add_texels(d, right, upper_right, sum);
}

/// Reflectances of lanes k and following, whose texels were read.
HWY_INLINE Rgb<Vector> filtered_lanes(const TexelPlaces& places, int k) {
    const Tag d;
    const Vector one = hn::Set(d, 1.0f);
    Rgb<Vector> sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (!places.blended) {
        add_bilinear(places, 0, k, one, sum);
        return sum;
    }
    const Vector blend = hn::Load(d, places.blend + k);
    add_bilinear(places, 0, k, hn::Sub(one, blend), sum);
    add_bilinear(places, 1, k, blend, sum);
    return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
