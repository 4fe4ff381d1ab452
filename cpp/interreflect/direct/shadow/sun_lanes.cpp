#include "direct/shadow/sun_lanes.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "direct/shadow/sun_lanes.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline: of each pixel normals, position, albedo and offset, 52 bytes, are read once, and nine texels of the map gathered.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t lanes = hn::MaxLanes(Tag());

/// The first `count` of a vector's values; 0 beyond.
HWY_INLINE Vec3 load3(const vec3* from, std::size_t count) {
    alignas(64) float some[3 * lanes] = {};
    const float* values = &from->x;
    if (count < lanes) std::copy_n(values, 3 * count, some), values = some;
    Vec3 v;
    hn::LoadInterleaved3(Tag(), values, v.x, v.y, v.z);
    return v;
}
HWY_INLINE Vector load1(const float* from, std::size_t count) {
    alignas(64) float some[lanes] = {};
    if (count < lanes) std::copy_n(from, count, some), from = some;
    return hn::LoadU(Tag(), from);
}
HWY_INLINE Vector dot(const vec3& a, const Vec3& b) {
    const Tag d;
    return dot(Vec3{hn::Set(d, a.x), hn::Set(d, a.y), hn::Set(d, a.z)}, b);
}

/// DepthMap::lit of an orthographic view where `facing` holds: from texel to texel the plane's depth changes evenly.
HWY_INLINE Vector lit(const DepthMap& map, LaneMask facing, const Vec3& position, const Vec3& normal, float bias, Vector offset) {
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    const LightView& view = map.view;
    const float size = static_cast<float>(view.size), step_x = 2.0f * view.half_x / size, step_y = 2.0f * view.half_y / size;
    const Vec3 to{hn::Sub(position.x, hn::Set(d, view.origin.x)), hn::Sub(position.y, hn::Set(d, view.origin.y)),
                  hn::Sub(position.z, hn::Set(d, view.origin.z))};
    const Vector one = hn::Set(d, 1.0f), zero = hn::Zero(d), half = hn::Set(d, 0.5f * size), limit = hn::Set(d, size);
    const Vector x = hn::MulAdd(dot(view.right, to), hn::Set(d, 1.0f / step_x), half),
                 y = hn::MulAdd(dot(view.down, to), hn::Set(d, 1.0f / step_y), half);
    const auto inside = hn::And(hn::And(hn::Ge(x, zero), hn::Lt(x, limit)), hn::And(hn::Ge(y, zero), hn::Lt(y, limit)));
    const auto compares = hn::And(inside, facing);
    const auto cx = hn::ConvertTo(di, hn::IfThenElseZero(compares, x)), cy = hn::ConvertTo(di, hn::IfThenElseZero(compares, y));
    // Where the ray through the own texel's centre meets the tangent plane, and how far on those beside do.
    const Vector across = hn::Mul(hn::Set(d, step_x), hn::Sub(hn::Add(hn::ConvertTo(d, cx), hn::Set(d, 0.5f)), half)),
                 along = hn::Mul(hn::Set(d, step_y), hn::Sub(hn::Add(hn::ConvertTo(d, cy), hn::Set(d, 0.5f)), half));
    const Vector inverse = hn::Div(one, dot(view.forward, normal));
    const Vector slope_x = hn::Mul(dot(view.right, normal), inverse), slope_y = hn::Mul(dot(view.down, normal), inverse);
    const Vector centre = hn::NegMulAdd(along, slope_y, hn::NegMulAdd(across, slope_x, hn::Mul(dot(to, normal), inverse)));
    const Vector margin = hn::Add(offset, hn::Set(d, bias * view.texel_width(1.0f)));
    Vector compared = zero, open = zero;
    for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) {
            const auto tx = hn::Add(cx, hn::Set(di, i)), ty = hn::Add(cy, hn::Set(di, j));
            const auto border =
                hn::Or(hn::Lt(hn::Min(tx, ty), hn::Zero(di)), hn::Gt(hn::Max(tx, ty), hn::Set(di, view.size - 1)));
            const Vector plane = hn::NegMulAdd(slope_y, hn::Set(d, static_cast<float>(j) * step_y),
                                               hn::NegMulAdd(slope_x, hn::Set(d, static_cast<float>(i) * step_x), centre));
            // A plane behind the start of the texel's ray: it is not compared.
            const auto counts = hn::And(hn::AndNot(hn::RebindMask(d, border), compares), hn::Gt(plane, zero));
            const auto texel = hn::IfThenElseZero(hn::RebindMask(di, counts), hn::Add(hn::Mul(ty, hn::Set(di, view.size)), tx));
            const Vector depth = hn::GatherIndex(d, map.depth.data(), texel);
            compared = hn::Add(compared, hn::IfThenElseZero(counts, one));
            open = hn::Add(open, hn::IfThenElseZero(hn::And(counts, hn::Ge(depth, hn::Sub(plane, margin))), one));
        }
    const Vector share = hn::Div(open, hn::Max(compared, one));
    return hn::IfThenElseZero(facing, hn::IfThenElse(inside, share, one));
}

void LightBySun(const LightSampler::Delta& sun, const DepthMap& map, float bias, const GBuffer& g, std::size_t first,
                SunlitRun& run) {
    const Tag d;
    const auto all = static_cast<std::size_t>(run.count);
    const vec3 scale = sun.irradiance / pi;
    for (std::size_t at = 0; at < all; at += lanes) {
        const std::size_t pixel = first + at, count = std::min(lanes, all - at);
        const Vec3 geometric = load3(&g.geometric_normal[pixel], count);  // (0, 0, 0) where nothing was hit
        const Vector cosine = dot(sun.direction, load3(&g.normal[pixel], count));
        const auto facing = hn::And(hn::Gt(cosine, hn::Zero(d)), hn::Gt(dot(sun.direction, geometric), hn::Zero(d)));
        Vector open = hn::Zero(d);
        if (!hn::AllFalse(d, facing))
            open = lit(map, facing, load3(&g.position[pixel], count), geometric, bias, load1(&g.offset[pixel], count));
        hn::Store(open, d, run.lit + at);
        const Vec3 albedo = load3(&g.albedo[pixel], count);
        const Vector arrives = hn::Mul(open, hn::Max(cosine, hn::Zero(d)));
        store3(
            {hn::Mul(hn::Mul(albedo.x, arrives), hn::Set(d, scale.x)), hn::Mul(hn::Mul(albedo.y, arrives), hn::Set(d, scale.y)),
             hn::Mul(hn::Mul(albedo.z, arrives), hn::Set(d, scale.z))},
            &run.diffuse[at].x);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(LightBySun);

void light_by_sun(const LightSampler::Delta& sun, const DepthMap& map, float bias, const GBuffer& gbuffer, std::size_t first,
                  SunlitRun& run) {
    HWY_DYNAMIC_DISPATCH(LightBySun)(sun, map, bias, gbuffer, first, run);
}
}  // namespace interreflect
#endif
