// The path tracer's inner loops. Included once for every vector target.
#if defined(INTERREFLECT_PATH_KERNEL) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_PATH_KERNEL
#undef INTERREFLECT_PATH_KERNEL
#else
#define INTERREFLECT_PATH_KERNEL
#endif

#include "shading/emitter_kernel-inl.h"
#include "visibility/camera_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Signed = hn::RebindToSigned<Tag>;
using Unsigned = hn::RebindToUnsigned<Tag>;
using Numbers = hn::Vec<Unsigned>;
using Index = hn::Vec<Signed>;

inline constexpr std::uint32_t lanes_a_vector = static_cast<std::uint32_t>(hn::MaxLanes(Tag()));

HWY_INLINE Vec3 load3(const Column3& c, std::uint32_t i) {
    const Tag d;
    return {hn::LoadU(d, c.x + i), hn::LoadU(d, c.y + i), hn::LoadU(d, c.z + i)};
}
HWY_INLINE Vec3 load_rows(const GlossyLanes::Lanes* rows) {
    const Tag d;
    return {hn::Load(d, rows[0]), hn::Load(d, rows[1]), hn::Load(d, rows[2])};
}
HWY_INLINE void store_vec3(const Vec3& v, GlossyLanes::Lanes* rows) {
    const Tag d;
    hn::Store(v.x, d, rows[0]);
    hn::Store(v.y, d, rows[1]);
    hn::Store(v.z, d, rows[2]);
}
HWY_INLINE void keep(Vector v, LaneMask mask, float* to) { hn::StoreU(hn::Compress(v, mask), Tag(), to); }
HWY_INLINE void keep(const Vec3& v, LaneMask mask, Column3& to, std::uint32_t at) {
    keep(v.x, mask, to.x + at), keep(v.y, mask, to.y + at), keep(v.z, mask, to.z + at);
}
HWY_INLINE void keep_numbers(Numbers v, LaneMask mask, std::uint32_t* to) {
    keep(hn::BitCast(Tag(), v), mask, reinterpret_cast<float*>(to));
}
HWY_INLINE Numbers load_numbers(const NumberColumn& from, std::uint32_t i) { return hn::LoadU(Unsigned(), from + i); }

/// Lanes of [i, ...) that are paths.
HWY_INLINE LaneMask lanes_within(std::uint32_t count, std::uint32_t i) {
    return hn::FirstN(Tag(), count - i < lanes_a_vector ? count - i : lanes_a_vector);
}

struct Pair {
    Vector x, y;
};
HWY_INLINE Pair load_pair(const PairTable& table, const NumberColumn& pattern, std::uint32_t i) {
    const Tag d;
    const Index at = hn::BitCast(Signed(), load_numbers(pattern, i));
    return {hn::GatherIndex(d, table.x, at), hn::GatherIndex(d, table.y, at)};
}

HWY_INLINE LaneMask glossy_lanes(const PathLanes& paths, std::uint32_t i) {
    const Unsigned du;
    return hn::RebindMask(Tag(), hn::Ne(load_numbers(paths.lobe, i), hn::Set(du, SurfacePacket::no_lobe)));
}
HWY_INLINE LaneMask lanes_if(bool all) { return hn::FirstN(Tag(), all ? lanes_a_vector : 0); }

/// Shadow rays of one vector of paths, with what they would bring.
HWY_INLINE void connect(const Connecting& c, std::uint32_t i, const LightLanes& light) {
    const Tag d;
    const Vector zero = hn::Zero(d);
    const PathLanes& p = c.paths;
    const Vec3 geometric = load3(p.geometric_normal, i);
    const Vector cosine = dot(load3(p.normal, i), light.direction);
    LaneMask lit = hn::And(lanes_within(p.count, i), hn::And(hn::Gt(light.pdf, zero), hn::Gt(cosine, zero)));
    Vec3 value = scaled(load3(p.albedo, i), number(1.0f / pi));
    Vector pdf = hn::Mul(cosine, number(1.0f / pi));
    LaneMask continues = lanes_if(c.continue_all);
    const LaneMask above = hn::Gt(dot(geometric, light.direction), zero);
    if (p.any_lobe) {
        GlossyLanes g;
        store_vec3(light.direction, g.direction);
        store_vec3(value, g.value);
        hn::Store(pdf, d, g.pdf);
        evaluate_glossy(p, c.materials, i, static_cast<int>(lanes_a_vector), g);
        value = load_rows(g.value);
        pdf = hn::Load(d, g.pdf);
        continues = hn::Or(continues, glossy_lanes(p, i));
    }
    lit = hn::And(lit, above);
    Vector scale = hn::Div(cosine, light.pdf);
    if (c.weighed) {
        const Vector ratio = hn::Div(pdf, light.pdf);
        const Vector weight = hn::Div(number(1.0f), hn::MulAdd(ratio, ratio, number(1.0f)));
        scale = hn::Mul(scale, hn::IfThenElse(continues, weight, number(1.0f)));
    }
    const Vec3 reflected = product(product(load3(p.throughput, i), value), scaled(light.radiance, scale));
    lit = hn::And(lit, hn::Gt(largest(reflected), zero));
    ShadowLanes& s = c.shadows;
    const Vector offset = hn::LoadU(d, p.offset + i);
    keep(moved(load3(p.position, i), geometric, offset), lit, s.origin, s.count);
    keep(light.direction, lit, s.direction, s.count);
    keep(reflected, lit, s.light, s.count);
    // The ray ends short of an emitter by more than rounding moves either end.
    keep(hn::NegMulAdd(number(2.0f), offset, hn::Mul(light.distance, number(0.9999f))), lit, s.far + s.count);
    keep_numbers(load_numbers(p.pixel, i), lit, s.pixel + s.count);
    s.count += static_cast<std::uint32_t>(hn::CountTrue(d, lit));
}

void connect_directional_lanes(const Connecting& c, const vec3& towards, const vec3& irradiance) {
    const LightLanes light{same(towards), hn::Inf(Tag()), same(irradiance), number(1.0f)};
    for (std::uint32_t i = 0; i < c.paths.count; i += lanes_a_vector) connect(c, i, light);
}

void connect_shapes_lanes(const Connecting& c, const EmitterShape* shapes, int count, const PairTable& choices,
                          const PairTable& points) {
    for (std::uint32_t i = 0; i < c.paths.count; i += lanes_a_vector) {
        const Pair u = load_pair(points, c.paths.pattern, i);
        const Vector choice = load_pair(choices, c.paths.pattern, i).x;
        connect(c, i, sample_shape_lanes(shapes, count, load3(c.paths.position, i), choice, u.x, u.y));
    }
}

void connect_constant_sky_lanes(const Connecting& c, const vec3& radiance, const PairTable& points) {
    for (std::uint32_t i = 0; i < c.paths.count; i += lanes_a_vector) {
        const Pair u = load_pair(points, c.paths.pattern, i);
        const Vec3 local = cosine_hemisphere_lanes(u.x, u.y);
        const Vec3 direction = to_world(load3(c.paths.normal, i), local);
        connect(c, i, {direction, hn::Inf(Tag()), same(radiance), hn::Mul(local.z, number(1.0f / pi))});
    }
}

void connect_given_lanes(const Connecting& c, const LightColumns& lights) {
    const Tag d;
    for (std::uint32_t i = 0; i < c.paths.count; i += lanes_a_vector)
        connect(c, i,
                {load3(lights.direction, i), hn::LoadU(d, lights.distance + i), load3(lights.radiance, i),
                 hn::LoadU(d, lights.pdf + i)});
}

/// A direction from one vector of paths, with weight and density.
struct Chosen {
    Vec3 direction, weight;
    Vector pdf;
    LaneMask above;
};
HWY_INLINE Chosen choose_diffuse(const PathLanes& p, std::uint32_t i, const Pair& u) {
    const Vec3 normal = load3(p.normal, i);
    const Vec3 direction = unit(to_world(normal, cosine_hemisphere_lanes(u.x, u.y)));
    const Vector cosine = dot(normal, direction), zero = hn::Zero(Tag());
    const LaneMask above = hn::And(hn::Gt(cosine, zero), hn::Gt(dot(load3(p.geometric_normal, i), direction), zero));
    return {direction, load3(p.albedo, i), hn::Mul(cosine, number(1.0f / pi)), above};
}
HWY_INLINE Chosen choose_with_lobes(const Choosing& c, std::uint32_t i, const Pair& u, const Chosen& diffuse) {
    const Tag d;
    GlossyLanes g;
    alignas(64) GlossyLanes::Lanes lobe, x, y;
    hn::Store(load_pair(c.choices, c.paths.pattern, i).y, d, lobe);
    hn::Store(u.x, d, x);
    hn::Store(u.y, d, y);
    store_vec3(diffuse.direction, g.direction);
    store_vec3(diffuse.weight, g.value);
    hn::Store(diffuse.pdf, d, g.pdf);
    sample_glossy(c.paths, c.materials, i, static_cast<int>(lanes_a_vector), lobe, x, y, g);
    // A sampled weight is 0 below a horizon.
    return {load_rows(g.direction), load_rows(g.value), hn::Load(d, g.pdf), hn::Or(diffuse.above, glossy_lanes(c.paths, i))};
}

void choose_rays_lanes(const Choosing& c, StepLanes& steps) {
    constexpr float most_survival = 0.95f;  // roulette ends even a path that loses nothing
    // The chance to go on over what the path still carries. In Sponza time x variance is 1.2 times more at 1 than at 2.5.
    constexpr float survival_of_throughput = 2.5f;
    const Tag d;
    const PathLanes& p = c.paths;
    for (std::uint32_t i = 0; i < p.count; i += lanes_a_vector) {
        const Pair u = load_pair(c.reflections, p.pattern, i);
        Chosen next = choose_diffuse(p, i, u);
        LaneMask kept = hn::And(lanes_within(p.count, i), lanes_if(c.continue_all));
        if (p.any_lobe) {
            next = choose_with_lobes(c, i, u, next);
            kept = hn::And(lanes_within(p.count, i), hn::Or(kept, glossy_lanes(p, i)));
        }
        Vec3 throughput = product(load3(p.throughput, i), next.weight);
        const Vector brightest = largest(throughput);
        kept = hn::And(kept, hn::And(next.above, hn::Gt(brightest, hn::Zero(d))));
        if (c.roulette) {
            const Vector survival = hn::Min(number(most_survival), hn::Mul(number(survival_of_throughput), brightest));
            kept = hn::And(kept, hn::Lt(load_pair(c.roulettes, p.pattern, i).x, survival));
            throughput = scaled(throughput, hn::Div(number(1.0f), survival));
        }
        const std::uint32_t at = steps.count;
        keep(moved(load3(p.position, i), load3(p.geometric_normal, i), hn::LoadU(d, p.offset + i)), kept, steps.origin, at);
        keep(next.direction, kept, steps.direction, at);
        keep(throughput, kept, steps.throughput, at);
        keep(next.pdf, kept, steps.pdf + at);
        keep_numbers(hn::Iota(Unsigned(), i), kept, steps.path + at);
        keep_numbers(load_numbers(p.pixel, i), kept, steps.pixel + at);
        keep_numbers(load_numbers(p.pattern, i), kept, steps.pattern + at);
        steps.count += static_cast<std::uint32_t>(hn::CountTrue(d, kept));
    }
}

void primary_rays_lanes(const CameraRays& camera, int x0, int y0, const PairTable& places, StepLanes& steps) {
    const Tag d;
    const Signed di;
    constexpr int log_tile = 5;
    static_assert(tracing_tile == 1 << log_tile);
    for (std::uint32_t i = 0; i < steps.count; i += lanes_a_vector) {
        const Index pixel = hn::BitCast(di, load_numbers(steps.pixel, i));
        const Pair place = load_pair(places, steps.pattern, i);
        const Vector column = hn::ConvertTo(d, hn::And(pixel, hn::Set(di, tracing_tile - 1)));
        const Vector row = hn::ConvertTo(d, hn::ShiftRight<log_tile>(pixel));
        const Vector x = hn::Add(hn::Add(number(static_cast<float>(x0)), column), place.x);
        const Vector y = hn::Add(hn::Add(number(static_cast<float>(y0)), row), place.y);
        const Vec3 direction = unit(towards_places(camera, x, y));
        hn::StoreU(direction.x, d, steps.direction.x + i);
        hn::StoreU(direction.y, d, steps.direction.y + i);
        hn::StoreU(direction.z, d, steps.direction.z + i);
    }
}

HWY_INLINE Vec3 load_packet(const SurfacePacket::Lanes* rows, std::uint32_t k) {
    const Tag d;
    return {hn::Load(d, rows[0] + k), hn::Load(d, rows[1] + k), hn::Load(d, rows[2] + k)};
}

void append_lanes(const SurfacePacket& s, std::uint32_t lanes, const StepLanes& steps, std::uint32_t first, PathLanes& paths) {
    const Tag d;
    const Unsigned du;
    for (std::uint32_t k = 0; k < RayPacket::width; k += lanes_a_vector) {
        const std::uint32_t bits = lanes >> k, i = first + k, at = paths.count;
        const auto lobe = hn::Load(du, s.lobe + k);
        const auto glossy = hn::RebindMask(d, hn::Ne(lobe, hn::Set(du, SurfacePacket::no_lobe)));
        const Vec3 albedo = load_packet(s.albedo, k);
        const LaneMask met = hn::LoadMaskBits(d, reinterpret_cast<const std::uint8_t*>(&bits));
        const LaneMask kept = hn::And(met, hn::Or(glossy, hn::Gt(largest(albedo), hn::Zero(d))));
        paths.any_lobe |= !hn::AllFalse(d, hn::And(kept, glossy));
        keep(load_packet(s.position, k), kept, paths.position, at);
        keep(load_packet(s.geometric_normal, k), kept, paths.geometric_normal, at);
        keep(load_packet(s.normal, k), kept, paths.normal, at);
        keep(albedo, kept, paths.albedo, at);
        keep(load3(steps.direction, i), kept, paths.direction, at);
        keep(load3(steps.throughput, i), kept, paths.throughput, at);
        keep(hn::Load(d, s.offset + k), kept, paths.offset + at);
        keep_numbers(lobe, kept, paths.lobe + at);
        keep_numbers(load_numbers(steps.pixel, i), kept, paths.pixel + at);
        keep_numbers(load_numbers(steps.pattern, i), kept, paths.pattern + at);
        paths.count += static_cast<std::uint32_t>(hn::CountTrue(d, kept));
    }
}

HWY_INLINE void gather_column(const float* from, Index at, float* to) {
    const Tag d;
    hn::StoreU(hn::GatherIndex(d, from, at), d, to);
}
HWY_INLINE void gather_column(const Column3& from, Index at, Column3& to, std::uint32_t i) {
    gather_column(from.x, at, to.x + i), gather_column(from.y, at, to.y + i), gather_column(from.z, at, to.z + i);
}
HWY_INLINE void gather_numbers(const NumberColumn& from, Index at, std::uint32_t* to) {
    gather_column(reinterpret_cast<const float*>(from), at, reinterpret_cast<float*>(to));
}

void reorder_lanes(const PathLanes& from, const NumberColumn& order, std::uint32_t count, PathLanes& to) {
    to.count = count;
    to.any_lobe = from.any_lobe;
    for (std::uint32_t i = 0; i < count; i += lanes_a_vector) {
        const Index at = hn::BitCast(Signed(), load_numbers(order, i));
        gather_column(from.position, at, to.position, i);
        gather_column(from.geometric_normal, at, to.geometric_normal, i);
        gather_column(from.normal, at, to.normal, i);
        gather_column(from.albedo, at, to.albedo, i);
        gather_column(from.direction, at, to.direction, i);
        gather_column(from.throughput, at, to.throughput, i);
        gather_column(from.offset, at, to.offset + i);
        gather_numbers(from.lobe, at, to.lobe + i);
        gather_numbers(from.pixel, at, to.pixel + i);
        gather_numbers(from.pattern, at, to.pattern + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
