#include "caches/interpolate/view_lanes.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/interpolate/view_lanes.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <hwy/contrib/math/math-inl.h>

#include <limits>

#include "caches/interpolate/pixel_rows-inl.h"

// Roofline: forty bytes of the G-buffer are read for every pixel; some 200 operations turn sixteen of them into lanes, and 80
// find their levels and albedos.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

bool load_pixels(const GBuffer& gbuffer, PixelViews& views, Reflections& lobes, float (*specular)[PixelViews::capacity]) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d)), whole = (views.count + lanes - 1) / lanes * lanes;
    for (int i = 0; i < whole; i += PixelRow::length) {
        const PixelRow row(views.pixel + i);
        row.load(gbuffer.position.data(), lobes.position[0] + i, lobes.position[1] + i, lobes.position[2] + i);
        row.load(gbuffer.normal.data(), lobes.normal[0] + i, lobes.normal[1] + i, lobes.normal[2] + i);
        row.load(gbuffer.specular.data(), specular[0] + i, specular[1] + i, specular[2] + i);
        row.load(gbuffer.alpha.data(), lobes.alpha + i);
    }
    Vector most = hn::Zero(d);
    for (int i = 0; i < whole; i += lanes)
        for (int k = 0; k < 3; ++k) {
            hn::Store(hn::Load(d, lobes.position[k] + i), d, views.position[k] + i);
            hn::Store(hn::Load(d, lobes.normal[k] + i), d, views.normal[k] + i);
            most = hn::Max(hn::Load(d, specular[k] + i), most);
        }
    return !hn::AllFalse(d, hn::Gt(most, hn::Zero(d)));
}

void enter_lobes(const Reflections& lobes, const float (*specular)[PixelViews::capacity], float level, PixelViews& views) {
    const Tag d;
    const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
    for (int i = 0; i < views.count; i += static_cast<int>(hn::Lanes(d))) {
        const Vector reflected[3] = {hn::Load(d, specular[0] + i), hn::Load(d, specular[1] + i), hn::Load(d, specular[2] + i)};
        const auto glossy = hn::Gt(hn::Max(hn::Max(reflected[0], reflected[1]), reflected[2]), zero);
        const Vector scale = hn::Load(d, lobes.scale + i), bias = hn::Load(d, lobes.bias + i);
        for (int k = 0; k < 3; ++k) {
            const Vector albedo = hn::Add(hn::Mul(reflected[k], scale), hn::Mul(hn::Sub(one, reflected[k]), bias));
            hn::Store(hn::IfThenElseZero(glossy, albedo), d, views.albedo[k] + i);
            hn::Store(hn::IfThenElseZero(glossy, hn::Load(d, lobes.direction[k] + i)), d, views.direction[k] + i);
        }
        hn::Store(hn::IfThenElse(glossy, hn::Set(d, level), hn::Set(d, PixelViews::no_lobe)), d, views.level + i);
    }
}

void find_levels(const LevelOfWidth& width, const float* half_angles, PixelViews& views) {
    const Tag d;
    for (int i = 0; i < views.count; i += static_cast<int>(hn::Lanes(d))) {
        const Vector part = hn::Sub(hn::Set(d, 1.0f), hn::Cos(d, hn::Load(d, half_angles + i)));
        const Vector texels = hn::Mul(hn::Max(part, hn::Set(d, 1e-8f)), hn::Set(d, 2.0f * pi / width.texel));
        const Vector level = hn::MulAdd(hn::Set(d, 0.5f), hn::Log2(d, texels), hn::Set(d, width.bias));
        const Vector within = hn::Min(hn::Max(level, hn::Zero(d)), hn::Set(d, width.last)), known = hn::Load(d, views.level + i);
        hn::Store(hn::IfThenElse(hn::Ge(known, hn::Zero(d)), within, known), d, views.level + i);
    }
}

void bound_levels(PixelViews& views) {
    const Tag d;
    const Vector none = hn::Set(d, PixelViews::no_lobe);
    Vector least = hn::Set(d, static_cast<float>(PixelViews::most_levels)), most = none;
    for (int i = 0; i < views.count; i += static_cast<int>(hn::Lanes(d))) {
        const Vector level = hn::Load(d, views.level + i);
        least = hn::Min(least, hn::IfThenElse(hn::Ge(level, hn::Zero(d)), level, least)), most = hn::Max(most, level);
    }
    views.finest = static_cast<int>(hn::GetLane(hn::MinOfLanes(d, least)));
    views.coarsest = std::max(static_cast<int>(std::ceil(hn::GetLane(hn::MaxOfLanes(d, most)))), -1);
}

void bound_group(const float* values, float& lower, float& upper) {
    const Tag d;
    const Vector infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    Vector least = infinite, most = hn::Neg(infinite);
    for (int i = 0; i < PixelViews::group; i += static_cast<int>(hn::Lanes(d))) {
        const Vector value = hn::Load(d, values + i);
        const auto finite = hn::Lt(hn::Abs(value), infinite);
        least = hn::Min(least, hn::IfThenElse(finite, value, infinite));
        most = hn::Max(most, hn::IfThenElse(finite, value, hn::Neg(infinite)));
    }
    lower = hn::GetLane(hn::MinOfLanes(d, least)), upper = hn::GetLane(hn::MaxOfLanes(d, most));
}

void bound_groups(PixelViews& views) {
    for (int k = 0; k < 3; ++k) {
        views.position_bounds[k].clear(), views.normal_bounds[k].clear();
        if (k < 2) views.screen_bounds[k].clear();
    }
    for (int g = 0; g * PixelViews::group < views.count; ++g) {
        const auto bound = [&](const float* values, PixelViews::Bounds& to)
                               HWY_ATTR { bound_group(values + g * PixelViews::group, to.lower[g], to.upper[g]); };
        for (int k = 0; k < 3; ++k)
            bound(views.position[k], views.position_bounds[k]), bound(views.normal[k], views.normal_bounds[k]);
        for (int k = 0; k < 2; ++k) bound(views.screen[k], views.screen_bounds[k]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(load_pixels);
HWY_EXPORT(enter_lobes);
HWY_EXPORT(find_levels);
HWY_EXPORT(bound_levels);
HWY_EXPORT(bound_groups);

bool load_pixels(const GBuffer& gbuffer, PixelViews& views, Reflections& lobes, float (*specular)[PixelViews::capacity]) {
    return HWY_DYNAMIC_DISPATCH(load_pixels)(gbuffer, views, lobes, specular);
}

void enter_lobes(const Reflections& lobes, const float (*specular)[PixelViews::capacity], float level, PixelViews& views) {
    HWY_DYNAMIC_DISPATCH(enter_lobes)(lobes, specular, level, views);
}

void find_levels(const LevelOfWidth& width, const float* half_angles, PixelViews& views) {
    HWY_DYNAMIC_DISPATCH(find_levels)(width, half_angles, views);
}

void bound_levels(PixelViews& views) { HWY_DYNAMIC_DISPATCH(bound_levels)(views); }

void bound_groups(PixelViews& views) { HWY_DYNAMIC_DISPATCH(bound_groups)(views); }

}  // namespace interreflect
#endif
