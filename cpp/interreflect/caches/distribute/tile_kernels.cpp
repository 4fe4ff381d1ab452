#include "caches/distribute/tile_kernels.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "caches/distribute/tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "voxels/march/opacity-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::RebindToSigned<Floats>;
using Numbers = hn::RebindToUnsigned<Floats>;
using V = hn::Vec<Floats>;
constexpr std::size_t most_lanes = HWY_MAX_BYTES / sizeof(float);

/// The next `count` (at most a vector) of packed vectors; what is beyond them is zero.
HWY_INLINE void load_vectors(Floats d, const vec3* from, std::size_t count, V& x, V& y, V& z) {
    const auto* data = reinterpret_cast<const float*>(from);
    if (count == hn::Lanes(d)) return hn::LoadInterleaved3(d, data, x, y, z);
    float padded[3 * most_lanes] = {};
    std::memcpy(padded, data, count * sizeof(vec3));
    hn::LoadInterleaved3(d, padded, x, y, z);
}

template <class D>
HWY_INLINE hn::Vec<D> load_some(D d, const hn::TFromD<D>* from, std::size_t count) {
    if (count == hn::Lanes(d)) return hn::LoadU(d, from);
    hn::TFromD<D> padded[most_lanes] = {};
    std::memcpy(padded, from, count * sizeof(float));
    return hn::LoadU(d, padded);
}
template <class D>
HWY_INLINE void store_some(D d, hn::Vec<D> values, hn::TFromD<D>* to, std::size_t count) {
    if (count == hn::Lanes(d)) return hn::StoreU(values, d, to);
    hn::TFromD<D> padded[most_lanes];
    hn::StoreU(values, d, padded);
    std::memcpy(to, padded, count * sizeof(float));
}

/// Calls body(begin, count) for vector after vector of `count` items, the last one maybe shorter.
template <class Body>
HWY_INLINE void each_vector(std::size_t count, const Body& body) {
    const std::size_t lanes = hn::Lanes(Floats());
    for (std::size_t begin = 0; begin < count; begin += lanes) body(begin, std::min(lanes, count - begin));
}

void bin_normals(const vec3* normal, std::size_t count, int bins, std::uint32_t* bin) {
    const Floats d;
    const Ints di;
    const V half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const auto cell = [&](V p) HWY_ATTR {
        const V at = hn::Mul(hn::MulAdd(p, half, half), hn::Set(d, static_cast<float>(bins)));
        return hn::ConvertTo(di, hn::Min(hn::Max(at, zero), hn::Set(d, static_cast<float>(bins) - 0.5f)));
    };
    each_vector(count, [&](std::size_t begin, std::size_t some) HWY_ATTR {
        V x, y, z;
        load_vectors(d, normal + begin, some, x, y, z);
        const V sum = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z)), inverse = hn::Div(one, sum);
        const V px = hn::Mul(x, inverse), pz = hn::Mul(z, inverse);
        const auto lower = hn::Lt(y, zero);
        const V folded_x = hn::IfThenElse(lower, hn::CopySign(hn::Sub(one, hn::Abs(pz)), px), px);
        const V folded_z = hn::IfThenElse(lower, hn::CopySign(hn::Sub(one, hn::Abs(px)), pz), pz);
        const auto number = hn::Add(cell(folded_x), hn::Mul(hn::Set(di, bins), cell(folded_z)));
        store_some(Numbers(), hn::BitCast(Numbers(), number), bin + begin, some);
    });
}

void nearest_axes(const vec3* normal, std::size_t count, const std::array<vec3, 3>& axes, std::uint32_t* axis) {
    const Floats d;
    const Ints di;
    each_vector(count, [&](std::size_t begin, std::size_t some) HWY_ATTR {
        V x, y, z;
        load_vectors(d, normal + begin, some, x, y, z);
        V most = hn::Set(d, -1.0f);
        auto nearest = hn::Zero(di);
        for (int k = 0; k < 3; ++k) {
            const vec3& to = axes[static_cast<std::size_t>(k)];
            const V along = hn::MulAdd(hn::Set(d, to.x), x, hn::MulAdd(hn::Set(d, to.y), y, hn::Mul(hn::Set(d, to.z), z)));
            const V size = hn::Abs(along);
            const auto nearer = hn::Gt(size, most);
            const auto end =
                hn::IfThenElse(hn::RebindMask(di, hn::Lt(along, hn::Zero(d))), hn::Set(di, 2 * k + 1), hn::Set(di, 2 * k));
            nearest = hn::IfThenElse(hn::RebindMask(di, nearer), end, nearest);
            most = hn::IfThenElse(nearer, size, most);
        }
        store_some(Numbers(), hn::BitCast(Numbers(), nearest), axis + begin, some);
    });
}

void slice_depths(const float* distance, std::size_t count, float inverse_near, float an_octave, std::uint32_t* slice) {
    const Floats d;
    const Ints di;
    const V middle = hn::Set(d, static_cast<float>(1 << 20));
    const V least = hn::Set(d, 1e-37f), infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    each_vector(count, [&](std::size_t begin, std::size_t some) HWY_ATTR {
        const V far = load_some(d, distance + begin, some);
        const V octave = log2_of(d, hn::Max(hn::Mul(far, hn::Set(d, inverse_near)), least));
        const V number = hn::Floor(hn::Mul(octave, hn::Set(d, an_octave)));
        const auto whole = hn::ConvertTo(di, hn::Add(hn::Min(hn::Max(number, hn::Neg(middle)), middle), middle));
        const auto hit = hn::RebindMask(di, hn::Lt(far, infinite));
        store_some(Numbers(), hn::BitCast(Numbers(), hn::IfThenElse(hit, whole, hn::Set(di, -1))), slice + begin, some);
    });
}

void score_pixels(const vec3* position, const vec3* normal, const std::uint32_t* slot, std::size_t count,
                  const ClusterLines& lines, float* score) {
    const Floats d;
    const Ints di;
    const V one = hn::Set(d, 1.0f);
    each_vector(count, [&](std::size_t begin, std::size_t some) HWY_ATTR {
        V x, y, z, nx, ny, nz;
        load_vectors(d, position + begin, some, x, y, z);
        load_vectors(d, normal + begin, some, nx, ny, nz);
        // Pixels in no cluster (slot -1) look at the first one's line.
        const auto of = hn::Max(hn::BitCast(di, load_some(Numbers(), slot + begin, some)), hn::Zero(di));
        const auto read = [&](std::size_t number)
                              HWY_ATTR { return hn::GatherIndex(d, lines.of.data() + number * lines.size, of); };
        const V inverse = read(6), lx = read(3), ly = read(4), lz = read(5);
        const V ax = hn::Mul(hn::Sub(x, read(0)), inverse), ay = hn::Mul(hn::Sub(y, read(1)), inverse),
                az = hn::Mul(hn::Sub(z, read(2)), inverse);
        const V out = hn::MulAdd(ax, lx, hn::MulAdd(ay, ly, hn::Mul(az, lz)));
        const V bx = hn::NegMulAdd(lx, out, ax), by = hn::NegMulAdd(ly, out, ay), bz = hn::NegMulAdd(lz, out, az);
        const V aside = hn::Sqrt(hn::MulAdd(bx, bx, hn::MulAdd(by, by, hn::Mul(bz, bz))));
        const V agreement = hn::MulAdd(nx, lx, hn::MulAdd(ny, ly, hn::Mul(nz, lz)));
        store_some(d, hn::Div(hn::Add(agreement, out), hn::Add(one, aside)), score + begin, some);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(bin_normals);
HWY_EXPORT(nearest_axes);
HWY_EXPORT(slice_depths);
HWY_EXPORT(score_pixels);

void bin_normals(const vec3* normal, std::size_t count, int bins, std::uint32_t* bin) {
    HWY_DYNAMIC_DISPATCH(bin_normals)(normal, count, bins, bin);
}
void nearest_axes(const vec3* normal, std::size_t count, const std::array<vec3, 3>& axes, std::uint32_t* axis) {
    HWY_DYNAMIC_DISPATCH(nearest_axes)(normal, count, axes, axis);
}
void slice_depths(const float* distance, std::size_t count, float inverse_near, float an_octave, std::uint32_t* slice) {
    HWY_DYNAMIC_DISPATCH(slice_depths)(distance, count, inverse_near, an_octave, slice);
}
void score_pixels(const vec3* position, const vec3* normal, const std::uint32_t* slot, std::size_t count,
                  const ClusterLines& lines, float* score) {
    HWY_DYNAMIC_DISPATCH(score_pixels)(position, normal, slot, count, lines, score);
}

}  // namespace interreflect
#endif
