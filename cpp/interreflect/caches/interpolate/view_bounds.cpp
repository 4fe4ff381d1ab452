#include "caches/interpolate/pixel_views.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/interpolate/view_bounds.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include <limits>

#include "math/lanes-inl.h"

// Roofline: 16 reductions of about ten instructions for sixteen pixels, a fifth of what one cache's weights cost for them.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

HWY_EXPORT(bound_groups);

void bound_groups(PixelViews& views) { HWY_DYNAMIC_DISPATCH(bound_groups)(views); }

}  // namespace interreflect
#endif
