// Cones projected to spherical harmonics, a cone a lane. Included once for every vector target.
#if defined(INTERREFLECT_CONE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_CONE_LANES
#undef INTERREFLECT_CONE_LANES
#else
#define INTERREFLECT_CONE_LANES
#endif

#include "data/light_caches.h"
#include "data/surfels.h"
#include "math/harmonic_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// octahedral_direction of places in the unit square, as 16 bits each.
HWY_INLINE Vec3 octahedral_lanes(Vector x, Vector z) {
    const Tag d;
    const Vector one = hn::Set(d, 1.0f), scale = hn::Set(d, 2.0f / 65535.0f);
    x = hn::MulSub(x, scale, one), z = hn::MulSub(z, scale, one);
    const Vector ax = hn::Abs(x), az = hn::Abs(z), y = hn::Sub(hn::Sub(one, ax), az);
    const auto below = hn::Lt(y, hn::Zero(d));
    const Vec3 folded{hn::IfThenElse(below, hn::CopySign(hn::Sub(one, az), x), x), y,
                      hn::IfThenElse(below, hn::CopySign(hn::Sub(one, ax), z), z)};
    return scaled(folded, hn::Div(one, hn::Sqrt(dot(folded, folded))));
}

/// zonal_cone of band l (math/spherical_harmonics.h): x is 1 - cosine, c2 and s2 cosine and sine squared.
template <int l>
HWY_INLINE Vector zonal_lanes(Vector x, Vector c, Vector c2, Vector s2) {
    const Tag d;
    const auto n = [&](float value) { return hn::Set(d, value); };
    if constexpr (l == 0) return hn::Mul(x, n(2.0f * pi));
    if constexpr (l == 1) return hn::Mul(s2, n(pi));
    if constexpr (l == 2) return hn::Mul(hn::Mul(s2, c), n(pi));
    if constexpr (l == 3) return hn::Mul(hn::Mul(s2, n(pi / 4.0f)), hn::MulSub(c2, n(5.0f), n(1.0f)));
    if constexpr (l == 4) return hn::Mul(hn::Mul(hn::Mul(s2, c), n(pi / 4.0f)), hn::MulSub(c2, n(7.0f), n(3.0f)));
    if constexpr (l == 5) return hn::Mul(hn::Mul(s2, n(pi / 8.0f)), hn::MulAdd(hn::MulSub(c2, n(21.0f), n(14.0f)), c2, n(1.0f)));
    if constexpr (l == 6)
        return hn::Mul(hn::Mul(hn::Mul(s2, c), n(pi / 8.0f)), hn::MulAdd(hn::MulSub(c2, n(33.0f), n(30.0f)), c2, n(5.0f)));
    if constexpr (l == 7)
        return hn::Mul(hn::Mul(s2, n(pi / 64.0f)),
                       hn::MulSub(hn::MulAdd(hn::MulSub(c2, n(429.0f), n(495.0f)), c2, n(135.0f)), c2, n(5.0f)));
}

/// What nodes send, one a lane.
template <class Nodes>
HWY_INLINE Vec3 sent_by(const NodeLight& light, Nodes node) {
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    if (!light.is_packed()) {
        const auto at = hn::Add(node, hn::Add(node, node));
        const float* const values = &light.value[0].x;
        return {hn::GatherIndex(d, values, at), hn::GatherIndex(d, values + 1, at), hn::GatherIndex(d, values + 2, at)};
    }
    const hn::RebindToUnsigned<Tag> du;
    const auto bits = hn::BitCast(du, hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(light.packed.data()), node));
    const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::ShiftRight<27>(bits), hn::Set(du, 127U - 24U)));
    const auto part = [&](auto shifted)
                          HWY_ATTR { return hn::ConvertTo(d, hn::BitCast(di, hn::And(shifted, hn::Set(du, 511U)))); };
    const Vec3 parts{part(bits), part(hn::ShiftRight<9>(bits)), part(hn::ShiftRight<18>(bits))};
    return scaled(parts, hn::Mul(hn::BitCast(d, exponent), hn::Set(d, light.unit)));
}

/// One cone a lane: where from, its zonal coefficients, and what it brings.
template <int bands>
struct ConeLanes {
    Vec3 direction, light;
    Vector zonal[bands];
};

/// Links [first, first + count) of the list, which goes on for a vector at least; lanes beyond bring nothing.
template <int bands>
HWY_INLINE ConeLanes<bands> load_cones(const CacheLinks& links, const NodeLight& light, std::size_t first, std::size_t count) {
    const Tag d;
    const hn::RebindToUnsigned<Tag> du;
    const hn::RebindToSigned<Tag> di;
    const hn::Rebind<std::uint16_t, Tag> words;
    hn::Vec<decltype(du)> node, shape, place;
    hn::LoadInterleaved3(du, &links.cones[first].node, node, shape, place);
    const auto low = hn::Set(du, 0xffffU);
    const auto there = hn::FirstN(du, count);
    const auto from = hn::BitCast(di, hn::IfThenElseZero(there, node));
    const hn::Rebind<hwy::float16_t, Tag> half;
    const auto promoted = [&](auto bits) HWY_ATTR {
        return hn::PromoteTo(d, hn::BitCast(half, hn::DemoteTo(words, hn::BitCast(di, bits))));
    };
    const auto number = [&](auto bits) HWY_ATTR { return hn::ConvertTo(d, hn::BitCast(di, bits)); };
    const Vector f = promoted(hn::And(hn::IfThenElseZero(there, shape), low)), s = promoted(hn::ShiftRight<16>(shape)),
                 c = hn::Sub(hn::Set(d, 1.0f), s);
    const Vector c2 = hn::Mul(c, c), s2 = hn::Mul(s, hn::Sub(hn::Set(d, 2.0f), s));
    ConeLanes<bands> cones;
    cones.direction = octahedral_lanes(number(hn::And(place, low)), number(hn::ShiftRight<16>(place)));
    cones.light = scaled(sent_by(light, from), f);
    [&]<int... l>(std::integer_sequence<int, l...>) { ((cones.zonal[l] = zonal_lanes<l>(s, c, c2, s2)), ...); }
    (std::make_integer_sequence<int, bands>());
    return cones;
}

/// Adds the cones' projections to the coefficients' sums, a lane each, but for harmonic_norms.
template <int bands>
HWY_INLINE void add_cones(const ConeLanes<bands>& cones, Vector (*sum)[bands * bands]) {
    const auto add = [&](int i, Vector value) HWY_ATTR {
        sum[0][i] = hn::MulAdd(value, cones.light.x, sum[0][i]);
        sum[1][i] = hn::MulAdd(value, cones.light.y, sum[1][i]);
        sum[2][i] = hn::MulAdd(value, cones.light.z, sum[2][i]);
    };
    visit_harmonics<bands>(cones.direction, [&](int l, int m, Vector p, Vector cosine, Vector sine) HWY_ATTR {
        const Vector value = hn::Mul(p, cones.zonal[l]);
        add(l * l + l + m, hn::Mul(value, cosine));
        if (m > 0) add(l * l + l - m, hn::Mul(value, sine));
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
