// Trilinear look-ups of sRGB textures, one lane a look-up. Included once for every vector target.
#if defined(INTERREFLECT_TEXTURE_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_TEXTURE_KERNEL
#undef INTERREFLECT_TEXTURE_KERNEL
#else
#define INTERREFLECT_TEXTURE_KERNEL
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

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

/// The four texels of a bilinear look-up, and how far between them it lies.
template <class D>
struct Taps {
    hn::Vec<hn::RebindToSigned<D>> t00, t10, t01, t11;
    hn::Vec<D> wx, wy;
};

/// Reads the texels around (u, v), both in [0, 1), in each lane's own level.
template <class D, class VI, class V = hn::Vec<D>>
HWY_INLINE Taps<D> read_taps(D d, const KernelMaterial& material, VI level, V u, V v) {
    const hn::RebindToSigned<D> di;
    const auto* table = reinterpret_cast<const std::int32_t*>(material.levels);
    const VI at = hn::Add(hn::Add(level, level), level);
    const VI width = hn::GatherIndex(di, table, at), height = hn::GatherIndex(di, table + 1, at),
             first = hn::GatherIndex(di, table + 2, at);
    const V half = hn::Set(d, 0.5f);
    const V x = hn::Sub(hn::Mul(u, hn::ConvertTo(d, width)), half), y = hn::Sub(hn::Mul(v, hn::ConvertTo(d, height)), half);
    const V fx = hn::Floor(x), fy = hn::Floor(y);
    VI x0 = hn::ConvertTo(di, fx), y0 = hn::ConvertTo(di, fy);
    const VI one = hn::Set(di, 1), zero = hn::Zero(di);
    VI x1 = hn::Add(x0, one), y1 = hn::Add(y0, one);
    x0 = hn::IfThenElse(hn::Lt(x0, zero), hn::Add(x0, width), x0);
    y0 = hn::IfThenElse(hn::Lt(y0, zero), hn::Add(y0, height), y0);
    x1 = hn::IfThenElse(hn::Lt(x1, width), x1, hn::Sub(x1, width));
    y1 = hn::IfThenElse(hn::Lt(y1, height), y1, hn::Sub(y1, height));
    const VI row0 = hn::Add(first, hn::Mul(y0, width)), row1 = hn::Add(first, hn::Mul(y1, width));
    const auto* texels = reinterpret_cast<const std::int32_t*>(material.texels);
    return {hn::GatherIndex(di, texels, hn::Add(row0, x0)),
            hn::GatherIndex(di, texels, hn::Add(row0, x1)),
            hn::GatherIndex(di, texels, hn::Add(row1, x0)),
            hn::GatherIndex(di, texels, hn::Add(row1, x1)),
            hn::Sub(x, fx),
            hn::Sub(y, fy)};
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void add_bilinear(D d, const Taps<D>& taps, V weight, Rgb<V>& sum) {
    const V upper = hn::Mul(weight, taps.wy), lower = hn::Sub(weight, upper);
    const V upper_right = hn::Mul(upper, taps.wx), lower_right = hn::Mul(lower, taps.wx);
    add_texels(d, taps.t00, hn::Sub(lower, lower_right), sum);
    add_texels(d, taps.t10, lower_right, sum);
    add_texels(d, taps.t01, hn::Sub(upper, upper_right), sum);
    add_texels(d, taps.t11, upper_right, sum);
}

/// As Texture::filtered; `area`: the footprint's, in texture coordinates. All texels are asked for before the first is decoded:
/// they come from far away.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Rgb<V> filtered_lanes(D d, const KernelMaterial& material, V u, V v, V area) {
    const hn::RebindToSigned<D> di;
    const V size = hn::Set(d, static_cast<float>(material.levels[0].width) * static_cast<float>(material.levels[0].height));
    const V one = hn::Set(d, 1.0f), last = hn::Set(d, static_cast<float>(material.level_count - 1));
    const V texels = hn::Max(hn::Mul(area, size), one);
    const V level = hn::Min(hn::Mul(hn::Set(d, 0.5f), hn::Log2(d, texels)), last);
    const V fine = hn::Floor(level), blend = hn::Sub(level, fine);
    const auto fine_level = hn::ConvertTo(di, fine);
    u = wrap_lanes(d, u);
    v = wrap_lanes(d, v);
    Rgb<V> sum{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const Taps<D> near = read_taps(d, material, fine_level, u, v);
    if (hn::AllTrue(d, hn::Eq(blend, hn::Zero(d)))) {
        add_bilinear(d, near, one, sum);
        return sum;
    }
    const auto coarse_level = hn::Min(hn::Add(fine_level, hn::Set(di, 1)), hn::Set(di, material.level_count - 1));
    const Taps<D> far = read_taps(d, material, coarse_level, u, v);
    add_bilinear(d, near, hn::Sub(one, blend), sum);
    add_bilinear(d, far, blend, sum);
    return sum;
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
