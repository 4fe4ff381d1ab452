// SimpleLookup, Pcf and Pcss: one light and many pixels, a vector of them at a time.
#include "virtual_lights/filter/pcf.h"
#include "virtual_lights/filter/pcss.h"
#include "virtual_lights/filter/poisson_disk.h"
#include "virtual_lights/filter/simple_lookup.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "virtual_lights/filter/filter_kernel.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "virtual_lights/filter/lookup_lanes-inl.h"

// Roofline, for a vector of sixteen pixels: a lookup is 45 operations without a division or a root, and sixteen loads from a map
// that fills the second cache. The loads take 53 % of the time of Pcss, which is 60 % of all at 1280 x 720.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

struct OneLookup {
    template <class Lookup>
    HWY_INLINE Vector lit(const ShadowedLight&, const Lookup& lookup, const Receiving& pixels, std::uint64_t& count) const {
        const Tag d;
        const Vector inverse = hn::Div(hn::Set(d, 1.0f), pixels.local.z);
        const Towards to = Towards::plane(hn::Mul(pixels.local.x, inverse), hn::Mul(pixels.local.y, inverse));
        count += hn::CountTrue(d, pixels.lit);
        return hn::IfThenZeroElse(lookup(pixels, to, pixels.lit).blocks, hn::Set(d, 1.0f));
    }
};

struct FixedDisk {
    int samples;
    float radius;  // of the map's square

    template <class Lookup>
    HWY_INLINE Vector lit(const ShadowedLight&, const Lookup& lookup, const Receiving& pixels, std::uint64_t& count) const {
        const Tag d;
        const Vector inverse = hn::Div(hn::Set(d, 1.0f), pixels.local.z);
        const Towards middle = Towards::plane(hn::Mul(pixels.local.x, inverse), hn::Mul(pixels.local.y, inverse));
        const Vector one = hn::Set(d, 1.0f);
        Vector sum = hn::Zero(d);
        const auto& disk = poisson_disk();
        for (int k = 0; k < samples; ++k) {
            const vec2 at = disk[k] * radius;
            const Towards to = Towards::map(hn::Add(middle.x, hn::Set(d, at.x)), hn::Add(middle.y, hn::Set(d, at.y)));
            sum = hn::Add(sum, hn::IfThenZeroElse(lookup(pixels, to, pixels.lit).blocks, one));
        }
        count += hn::CountTrue(d, pixels.lit) * static_cast<std::uint64_t>(samples);
        return hn::Mul(sum, hn::Set(d, 1.0f / static_cast<float>(samples)));
    }
};

struct PenumbraDisk {
    int blocker_samples, filter_samples;
    float nearest_blocker;

    template <class Lookup>
    HWY_INLINE Vector lit(const ShadowedLight& light, const Lookup& lookup, const Receiving& pixels, std::uint64_t& count) const {
        const Tag d;
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const Vector inverse = hn::Div(one, pixels.local.z);  // 1 / planar depth of the pixel
        const Vector px = hn::Mul(pixels.local.x, inverse), py = hn::Mul(pixels.local.y, inverse);
        const auto& disk = poisson_disk();
        const auto around = [&](int k, Vector spread) HWY_ATTR {
            const vec2 at = disk[k];
            return Towards::plane(hn::MulAdd(spread, hn::Set(d, at.x), px), hn::MulAdd(spread, hn::Set(d, at.y), py));
        };
        // Penumbra of a blocker at planar depth z_b, seen from the light in the plane at distance 1: R (z_r - z_b) / (z_b z_r).
        const Vector radius = hn::Set(d, light.disk.radius());
        const Vector least = lookup.half_texel(Towards::plane(px, py).direction);
        const Vector search = hn::Max(hn::Mul(hn::Mul(radius, inverse), hn::Set(d, 1.0f / nearest_blocker - 1.0f)), least);
        Vector depths = zero, blockers = zero;
        for (int k = 0; k < blocker_samples; ++k) {
            const Towards to = around(k, search);
            const Seen seen = lookup(pixels, to, pixels.lit);
            depths = hn::Add(depths, hn::IfThenElseZero(seen.blocks, seen.planar));
            blockers = hn::Add(blockers, hn::IfThenElseZero(seen.blocks, one));
        }
        const LaneMask shadowed = hn::And(hn::Gt(blockers, zero), pixels.lit);
        count += hn::CountTrue(d, pixels.lit) * static_cast<std::uint64_t>(blocker_samples);
        if (hn::AllFalse(d, shadowed)) return one;
        count += hn::CountTrue(d, shadowed) * static_cast<std::uint64_t>(filter_samples);
        const Vector blocker = hn::Max(hn::Div(depths, hn::Max(blockers, one)), hn::Set(d, 1e-20f));
        const Vector width = hn::Max(hn::Mul(radius, hn::Sub(hn::Div(one, blocker), inverse)), least);
        Vector sum = zero;
        for (int k = 0; k < filter_samples; ++k) {
            const Towards to = around(k, width);
            sum = hn::Add(sum, hn::IfThenZeroElse(lookup(pixels, to, shadowed).blocks, one));
        }
        return hn::IfThenElse(shadowed, hn::Mul(sum, hn::Set(d, 1.0f / static_cast<float>(filter_samples))), one);
    }
};

template <class Filter, class Lookup>
HWY_INLINE std::uint64_t filter_with(const Filter& filter, const Lookup& lookup, const ShadowedLight& light,
                                     const Receivers& receivers, const float* irradiance, float* visible) {
    const Tag d;
    std::uint64_t count = 0;
    for (int i = 0; i < receivers.padded(); i += static_cast<int>(hn::Lanes(d))) {
        const LaneMask reached = hn::Gt(hn::Load(d, irradiance + i), hn::Zero(d));
        if (hn::AllFalse(d, reached)) continue;
        const Receiving pixels(light, receivers, i, reached);
        hn::Store(hn::IfThenElseZero(pixels.lit, filter.lit(light, lookup, pixels, count)), d, visible + i);
    }
    return count;
}
template <class Filter>
std::uint64_t filter_by(const Filter& filter, const ShadowedLight& light, const Receivers& receivers, const float* irradiance,
                        float* visible) {
    return light.shadows.kind == LightShadows::Kind::maps
               ? filter_with(filter, MapLookup(light), light, receivers, irradiance, visible)
               : filter_with(filter, RayLookup(light), light, receivers, irradiance, visible);
}

std::uint64_t filter_simple(const ShadowedLight& light, const Receivers& receivers, const float* irradiance, float* visible) {
    return filter_by(OneLookup{}, light, receivers, irradiance, visible);
}
std::uint64_t filter_pcf(const Pcf& pcf, const ShadowedLight& light, const Receivers& receivers, const float* irradiance,
                         float* visible) {
    // Without a map, texels are those of the paper's maps.
    const int size = light.shadows.size > 0 ? light.shadows.size : 128;
    return filter_by(FixedDisk{pcf.samples, static_cast<float>(pcf.radius) / static_cast<float>(size)}, light, receivers,
                     irradiance, visible);
}
std::uint64_t filter_pcss(const Pcss& pcss, const ShadowedLight& light, const Receivers& receivers, const float* irradiance,
                          float* visible) {
    return filter_by(PenumbraDisk{pcss.blocker_samples, pcss.filter_samples, static_cast<float>(pcss.nearest_blocker)}, light,
                     receivers, irradiance, visible);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
namespace {

void count_lookups(const ShadowedLight& light, std::uint64_t lookups, Counts& counts) {
    (light.shadows.kind == LightShadows::Kind::maps ? counts.shadow_lookups : counts.rays) += lookups;
}

}  // namespace
HWY_EXPORT(filter_simple);
HWY_EXPORT(filter_pcf);
HWY_EXPORT(filter_pcss);

void visibility(const SimpleLookup&, const ShadowedLight& light, const Receivers& receivers, const PerReceiver& irradiance,
                std::uint32_t, PerReceiver& visible, Counts& counts) {
    count_lookups(light, HWY_DYNAMIC_DISPATCH(filter_simple)(light, receivers, irradiance.value, visible.value), counts);
}
void visibility(const Pcf& technique, const ShadowedLight& light, const Receivers& receivers, const PerReceiver& irradiance,
                std::uint32_t, PerReceiver& visible, Counts& counts) {
    count_lookups(light, HWY_DYNAMIC_DISPATCH(filter_pcf)(technique, light, receivers, irradiance.value, visible.value), counts);
}
void visibility(const Pcss& technique, const ShadowedLight& light, const Receivers& receivers, const PerReceiver& irradiance,
                std::uint32_t, PerReceiver& visible, Counts& counts) {
    count_lookups(light, HWY_DYNAMIC_DISPATCH(filter_pcss)(technique, light, receivers, irradiance.value, visible.value), counts);
}

}  // namespace interreflect
#endif
