#include "caches/interpolate/finish.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/interpolate/finish_lanes.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "caches/interpolate/pixel_rows-inl.h"

// Roofline: fifty-six bytes are written for every pixel, after some 150 operations for sixteen of them.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The light of one vector of pixels.
struct FinishedLanes {
    static constexpr int most = hn::MaxLanes(Tag());
    alignas(64) float irradiance[3][most], sky[3][most], radiance[3][most], glossy_sky[3][most], occlusion[most], weight[most];

    /// finish_pixel where caches reach, zero elsewhere.
    HWY_INLINE FinishedLanes(const FilledCaches& filled, const PixelViews& views, const CacheSums& sums, int i) {
        const Tag d;
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f), sum = hn::Load(d, sums.weight + i);
        const auto covered = hn::Gt(sum, zero);
        const Vector mean = hn::IfThenElseZero(covered, hn::Div(one, sum));
        const Vector unit = hn::Mul(mean, hn::Set(d, filled.scale)), sky_unit = hn::Mul(mean, hn::Set(d, filled.sky_scale));
        const Vector open = hn::Mul(hn::Load(d, sums.diffuse[3] + i), mean);
        const Vector glossy_open = hn::Mul(hn::Load(d, sums.glossy[3] + i), mean);
        hn::Store(sum, d, weight);
        hn::Store(hn::IfThenElseZero(covered, hn::Min(hn::Max(hn::Sub(one, open), zero), one)), d, occlusion);
        const auto times_pi = [d](Vector value) HWY_ATTR { return hn::Mul(hn::Set(d, pi), value); };
        for (int k = 0; k < 3; ++k) {
            const Vector albedo = hn::Load(d, views.albedo[k] + i), constant = hn::Set(d, filled.sky_radiance[k]);
            hn::Store(hn::Mul(hn::Load(d, sums.diffuse[k] + i), times_pi(unit)), d, irradiance[k]);
            hn::Store(hn::Mul(hn::Mul(hn::Load(d, sums.glossy[k] + i), albedo), unit), d, radiance[k]);
            if (filled.sky.empty()) {
                hn::Store(hn::Mul(constant, times_pi(open)), d, sky[k]);
                hn::Store(hn::Mul(albedo, hn::Mul(constant, glossy_open)), d, glossy_sky[k]);
            } else {
                hn::Store(hn::Mul(hn::Load(d, sums.diffuse_sky[k] + i), times_pi(sky_unit)), d, sky[k]);
                hn::Store(hn::Mul(albedo, hn::Mul(hn::Load(d, sums.glossy_sky[k] + i), sky_unit)), d, glossy_sky[k]);
            }
        }
    }
};

void finish_lanes(const FilledCaches& filled, const PixelViews& views, const CacheSums& sums, CacheLight& light) {
    for (int i = 0; i < views.count; i += FinishedLanes::most) {
        const FinishedLanes lanes(filled, views, sums, i);
        for (int k = 0; k < std::min(FinishedLanes::most, views.count - i); k += PixelRow::length) {
            const PixelRow row(views.pixel + i + k);
            const int count = views.count - i - k;
            const auto store = [&](const float(&from)[3][FinishedLanes::most], Buffer<vec3>& to)
                                   HWY_ATTR { row.store(from[0] + k, from[1] + k, from[2] + k, count, to.data()); };
            store(lanes.irradiance, light.gathered.irradiance), store(lanes.sky, light.gathered.sky);
            store(lanes.radiance, light.glossy.radiance), store(lanes.glossy_sky, light.glossy.sky);
            row.store(lanes.occlusion + k, count, light.gathered.occlusion.data());
            row.store(lanes.weight + k, count, light.weight.data());
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(finish_lanes);

void finish_pixels(const ConvolvedCaches& caches, const PixelViews& views, const CacheSums& sums, CacheLight& light,
                   Served& served) {
    HWY_DYNAMIC_DISPATCH(finish_lanes)(*caches.filled, views, sums, light);
    for (int i = 0; i < views.count; ++i)
        if (sums.weight[i] > 0.0f)
            ++served.covered;
        else
            served.uncovered.push_back(views.pixel[i]);
}

}  // namespace interreflect
#endif
