// SimpleLookup, Pcf and Pcss: one light and many pixels, a vector of them at a time.
#include <algorithm>

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

// Roofline, for a vector of sixteen pixels: a lookup is 45 operations without a division or a root, and sixteen loads from a map.
// The loads take half of the time of Pcss, and it is the gathers themselves: maps of 32^2, which fit the first cache, take .93 of
// the time of 128^2.
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

/// Pixels in the penumbra of one light, packed side by side: of the vectors that search for blockers few lanes may need more.
struct alignas(64) Penumbra {
    static constexpr int most = Receivers::capacity + 16;  // a vector is stored whole
    float px[most], py[most], width[most];                 // in the plane at distance 1 along the light's normal
    float sum[most];                                       // of lookups that are lit
    float plane[3][most], distance[most], height[most];
    std::int32_t receiver[most];
    int count = 0;

    HWY_INLINE void add(const Receiving& pixels, Vector at_x, Vector at_y, Vector spread, Vector lit,
                        hn::Vec<hn::RebindToSigned<Tag>> number, LaneMask mask) {
        const Tag d;
        const auto pack = [&](Vector v, float* to) HWY_ATTR { hn::StoreU(hn::Compress(v, mask), d, to + count); };
        pack(at_x, px), pack(at_y, py), pack(spread, width), pack(lit, sum);
        pack(pixels.plane.x, plane[0]), pack(pixels.plane.y, plane[1]), pack(pixels.plane.z, plane[2]);
        pack(pixels.distance, distance), pack(pixels.height, height);
        const hn::RebindToSigned<Tag> di;
        hn::StoreU(hn::Compress(number, hn::RebindMask(di, mask)), di, receiver + count);
        count += static_cast<int>(hn::CountTrue(d, mask));
    }
    HWY_INLINE Receiving at(int i) const {
        const Tag d;
        const LaneMask filled = hn::FirstN(d, static_cast<std::size_t>(count - i));
        const auto load = [&](const float* from) HWY_ATTR { return hn::MaskedLoad(filled, d, from + i); };
        return {{load(plane[0]), load(plane[1]), load(plane[2])}, load(distance), load(height), filled};
    }
};

template <class Lookup>
class PenumbraDisk {
  public:
    HWY_INLINE PenumbraDisk(const Pcss& pcss, const ShadowedLight& light, const Lookup& lookup)
        : pcss_(pcss),
          lookup_(lookup),
          radius_(hn::Set(Tag(), light.disk.radius())),
          reach_(hn::Set(Tag(), 1.0f / static_cast<float>(pcss.nearest_blocker) - 1.0f)) {}

    /// Of pixels that have some blockers but are not all in the umbra, nothing is known yet: they are added to `penumbra`.
    HWY_INLINE Vector search(const Receiving& pixels, int first, Penumbra& penumbra, std::uint64_t& count) const {
        const Tag d;
        const Vector zero = hn::Zero(d), one = hn::Set(d, 1.0f);
        const Vector inverse = hn::Div(one, pixels.local.z);  // 1 / planar depth of the pixel
        const Vector px = hn::Mul(pixels.local.x, inverse), py = hn::Mul(pixels.local.y, inverse);
        // Penumbra of a blocker at planar depth z_b, seen from the light in the plane at distance 1: R (z_r - z_b) / (z_b z_r).
        const Vector least = lookup_.half_texel(Towards::plane(px, py).direction);
        const Vector spread = hn::Max(hn::Mul(hn::Mul(radius_, inverse), reach_), least);
        Vector depths = zero, blockers = zero;
        for (int k = 0; k < pcss_.blocker_samples; ++k) {
            const Seen seen = lookup_(pixels, around(k, spread, px, py), pixels.lit);
            depths = hn::Add(depths, hn::IfThenElseZero(seen.blocks, seen.planar));
            blockers = hn::Add(blockers, hn::IfThenElseZero(seen.blocks, one));
        }
        count += hn::CountTrue(d, pixels.lit) * static_cast<std::uint64_t>(pcss_.blocker_samples);
        const LaneMask shadowed = hn::And(hn::Gt(blockers, zero), pixels.lit);
        if (hn::AllFalse(d, shadowed)) return one;
        const Vector blocker = hn::Max(hn::Div(depths, hn::Max(blockers, one)), hn::Set(d, 1e-20f));
        const Vector width = hn::Max(hn::Mul(radius_, hn::Sub(hn::Div(one, blocker), inverse)), least);
        const LaneMask umbra =
            hn::And(hn::Ge(blockers, hn::Set(d, static_cast<float>(pcss_.blocker_samples))), hn::Le(width, spread));
        const LaneMask open = hn::AndNot(umbra, shadowed);
        if (!hn::AllFalse(d, open)) penumbra.add(pixels, px, py, width, zero, hn::Iota(hn::RebindToSigned<Tag>(), first), open);
        return hn::IfThenZeroElse(shadowed, one);
    }
    /// Where the first half of the lookups agree the other half is left out [Uralsky 2005].
    HWY_INLINE void filter(const Penumbra& penumbra, float* visible, std::uint64_t& count) const {
        const int samples = pcss_.filter_samples, probes = samples >= 8 ? samples / 2 : samples;
        Penumbra rest;
        look_up(penumbra, 0, probes, visible, probes < samples ? &rest : nullptr, count);
        if (probes < samples) look_up(rest, probes, samples, visible, nullptr, count);
    }

  private:
    HWY_INLINE Towards around(int k, Vector spread, Vector px, Vector py) const {
        const Tag d;
        const vec2 at = disk_[static_cast<std::size_t>(k)];
        return Towards::plane(hn::MulAdd(spread, hn::Set(d, at.x), px), hn::MulAdd(spread, hn::Set(d, at.y), py));
    }

    /// `rest`: those that lookups up to number `end` do not agree on.
    HWY_INLINE void look_up(const Penumbra& penumbra, int begin, int end, float* visible, Penumbra* rest,
                            std::uint64_t& count) const {
        const Tag d;
        const hn::RebindToSigned<Tag> di;
        const int lanes = static_cast<int>(hn::Lanes(d));
        const Vector all = hn::Set(d, static_cast<float>(end));
        alignas(64) float share[16];
        for (int i = 0; i < penumbra.count; i += lanes) {
            const Receiving pixels = penumbra.at(i);
            const auto load = [&](const float* from) HWY_ATTR { return hn::MaskedLoad(pixels.lit, d, from + i); };
            const Vector px = load(penumbra.px), py = load(penumbra.py), width = load(penumbra.width);
            Vector sum = load(penumbra.sum);
            for (int k = begin; k < end; ++k) {
                const Seen seen = lookup_(pixels, around(k, width, px, py), pixels.lit);
                sum = hn::Add(sum, hn::IfThenZeroElse(seen.blocks, hn::Set(d, 1.0f)));
            }
            const LaneMask open = hn::And(pixels.lit, hn::And(hn::Gt(sum, hn::Zero(d)), hn::Lt(sum, all)));
            if (rest != nullptr && !hn::AllFalse(d, open))
                rest->add(pixels, px, py, width, sum, hn::LoadU(di, penumbra.receiver + i), open);
            hn::Store(hn::Div(sum, all), d, share);
            for (int k = 0; k < std::min(lanes, penumbra.count - i); ++k) visible[penumbra.receiver[i + k]] = share[k];
        }
        count += static_cast<std::uint64_t>(penumbra.count) * static_cast<std::uint64_t>(end - begin);
    }

    const Pcss& pcss_;
    Lookup lookup_;
    const std::array<vec2, most_disk_points>& disk_ = poisson_disk();
    Vector radius_, reach_;
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

template <class Lookup>
HWY_INLINE std::uint64_t filter_penumbra(const Pcss& pcss, const Lookup& lookup, const ShadowedLight& light,
                                         const Receivers& receivers, const float* irradiance, float* visible) {
    const Tag d;
    const PenumbraDisk<Lookup> disk(pcss, light, lookup);
    Penumbra penumbra;
    std::uint64_t count = 0;
    for (int i = 0; i < receivers.padded(); i += static_cast<int>(hn::Lanes(d))) {
        const LaneMask reached = hn::Gt(hn::Load(d, irradiance + i), hn::Zero(d));
        if (hn::AllFalse(d, reached)) continue;
        const Receiving pixels(light, receivers, i, reached);
        hn::Store(hn::IfThenElseZero(pixels.lit, disk.search(pixels, i, penumbra, count)), d, visible + i);
    }
    disk.filter(penumbra, visible, count);
    return count;
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
    return light.shadows.kind == LightShadows::Kind::maps
               ? filter_penumbra(pcss, MapLookup(light), light, receivers, irradiance, visible)
               : filter_penumbra(pcss, RayLookup(light), light, receivers, irradiance, visible);
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
