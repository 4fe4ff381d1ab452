#include "caches/distribute/tile_kernels.h"

#include <algorithm>
#include <limits>

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
static_assert(most_lanes <= most_at_once);

/// Calls body(begin) for vector after vector; the last one may reach beyond.
template <class Body>
HWY_INLINE void each_vector(std::size_t count, const Body& body) {
    const std::size_t lanes = hn::Lanes(Floats());
    for (std::size_t begin = 0; begin < count; begin += lanes) body(begin);
}

/// Calls body(data, at) for vector after vector of a rectangle's rows: `data` has as many items, whose place is `at`. What is
/// beyond a row is written over by the next one.
template <class Item, class Body>
HWY_INLINE void each_in_rows(std::span<const Item> from, const Rows& rows, const Body& body) {
    const std::size_t lanes = hn::Lanes(Floats());
    for (std::size_t y = 0; y < rows.count; ++y)
        for (std::size_t x = 0; x < rows.columns; x += lanes) {
            const std::size_t begin = rows.first + y * rows.step + x;
            if (begin + lanes <= from.size()) {
                body(from.data() + begin, y * rows.columns + x);
            } else {
                Item padded[most_lanes] = {};
                std::copy(from.begin() + static_cast<std::ptrdiff_t>(begin), from.end(), padded);
                body(padded, y * rows.columns + x);
            }
        }
}

void copy_vectors(std::span<const vec3> from, const Rows& rows, Coordinates& to) {
    const Floats d;
    for (auto& each : to) each.resize(with_room(rows.columns * rows.count));
    float *const to_x = to[0].data(), *const to_y = to[1].data(), *const to_z = to[2].data();
    each_in_rows(from, rows, [&](const vec3* data, std::size_t at) HWY_ATTR {
        V x, y, z;
        hn::LoadInterleaved3(d, reinterpret_cast<const float*>(data), x, y, z);
        hn::StoreU(x, d, to_x + at), hn::StoreU(y, d, to_y + at), hn::StoreU(z, d, to_z + at);
    });
}

void copy_numbers(std::span<const float> from, const Rows& rows, std::vector<float>& to) {
    const Floats d;
    to.resize(with_room(rows.columns * rows.count));
    each_in_rows(from, rows,
                 [&](const float* data, std::size_t at) HWY_ATTR { hn::StoreU(hn::LoadU(d, data), d, to.data() + at); });
}

struct Vectors {
    V x, y, z;

    HWY_INLINE Vectors(const Coordinates& of, std::size_t begin)
        : x(hn::LoadU(Floats(), of[0].data() + begin)),
          y(hn::LoadU(Floats(), of[1].data() + begin)),
          z(hn::LoadU(Floats(), of[2].data() + begin)) {}
};

/// Those of the next vector that are less than infinite.
HWY_INLINE hn::Mask<Ints> finite(const float* depth, std::size_t left) {
    const Floats d;
    const V infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    const auto there = hn::FirstN(d, std::min(hn::Lanes(d), left));
    return hn::RebindMask(Ints(), hn::And(there, hn::Lt(hn::LoadU(d, depth), infinite)));
}

/// Calls body(lanes, number) for every different number among the lanes `left`. numbers: the same in memory.
template <class Body>
HWY_INLINE void each_number(hn::Vec<Ints> number, const std::int32_t* numbers, hn::Mask<Ints> left, const Body& body) {
    const Ints di;
    while (!hn::AllFalse(di, left)) {
        const std::int32_t shared = numbers[hn::FindKnownFirstTrue(di, left)];
        const auto same = hn::And(left, hn::Eq(number, hn::Set(di, shared)));
        body(same, static_cast<std::size_t>(shared));
        left = hn::AndNot(same, left);
    }
}

void count_normals(const Coordinates& normal, const float* depth, std::size_t count, int bins, float* histogram) {
    const Floats d;
    const Ints di;
    const V half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f), zero = hn::Zero(d);
    const auto cell = [&](V p) HWY_ATTR {
        const V at = hn::Mul(hn::MulAdd(p, half, half), hn::Set(d, static_cast<float>(bins)));
        return hn::ConvertTo(di, hn::Min(hn::Max(at, zero), hn::Set(d, static_cast<float>(bins) - 0.5f)));
    };
    each_vector(count, [&](std::size_t begin) HWY_ATTR {
        const auto [x, y, z] = Vectors(normal, begin);
        const V sum = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z)), inverse = hn::Div(one, sum);
        const V px = hn::Mul(x, inverse), pz = hn::Mul(z, inverse);
        const auto lower = hn::Lt(y, zero);
        const V folded_x = hn::IfThenElse(lower, hn::CopySign(hn::Sub(one, hn::Abs(pz)), px), px);
        const V folded_z = hn::IfThenElse(lower, hn::CopySign(hn::Sub(one, hn::Abs(px)), pz), pz);
        const auto bin = hn::Add(cell(folded_x), hn::Mul(hn::Set(di, bins), cell(folded_z)));
        std::int32_t of_each[most_lanes];
        hn::StoreU(bin, di, of_each);
        each_number(bin, of_each, finite(depth + begin, count - begin), [&](auto same, std::size_t number) HWY_ATTR {
            histogram[number] += static_cast<float>(hn::CountTrue(di, same));
        });
    });
}

std::size_t first_largest(const float* numbers, std::size_t count) {
    const Floats d;
    const auto next = [&](std::size_t begin) HWY_ATTR {
        const auto there = hn::FirstN(d, std::min(hn::Lanes(d), count - begin));
        return hn::IfThenElse(there, hn::LoadU(d, numbers + begin), hn::Set(d, -1.0f));
    };
    V most = hn::Set(d, -1.0f);
    each_vector(count, [&](std::size_t begin) HWY_ATTR { most = hn::Max(most, next(begin)); });
    most = hn::MaxOfLanes(d, most);
    for (std::size_t begin = 0; begin < count; begin += hn::Lanes(d)) {
        const auto largest = hn::Eq(next(begin), most);
        if (!hn::AllFalse(d, largest)) return begin + hn::FindKnownFirstTrue(d, largest);
    }
    return 0;
}

void nearest_axes(const Coordinates& normal, std::size_t count, const std::array<vec3, 3>& axes, std::uint32_t* axis) {
    const Floats d;
    const Ints di;
    each_vector(count, [&](std::size_t begin) HWY_ATTR {
        const auto [x, y, z] = Vectors(normal, begin);
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
        hn::StoreU(hn::BitCast(Numbers(), nearest), Numbers(), axis + begin);
    });
}

void slice_depths(const float* distance, std::size_t count, float inverse_near, float an_octave, std::uint32_t* slice) {
    const Floats d;
    const Ints di;
    const V middle = hn::Set(d, static_cast<float>(1 << 20));
    const V least = hn::Set(d, 1e-37f), infinite = hn::Set(d, std::numeric_limits<float>::infinity());
    each_vector(count, [&](std::size_t begin) HWY_ATTR {
        const V far = hn::LoadU(d, distance + begin);
        const V octave = log2_of(d, hn::Max(hn::Mul(far, hn::Set(d, inverse_near)), least));
        const V number = hn::Floor(hn::Mul(octave, hn::Set(d, an_octave)));
        const auto whole = hn::ConvertTo(di, hn::Add(hn::Min(hn::Max(number, hn::Neg(middle)), middle), middle));
        const auto hit = hn::RebindMask(di, hn::Lt(far, infinite));
        hn::StoreU(hn::BitCast(Numbers(), hn::IfThenElse(hit, whole, hn::Set(di, -1))), Numbers(), slice + begin);
    });
}

/// read(part, of): that part of each pixel's cluster's line.
template <class Read>
HWY_INLINE V scores(const Vectors& at, const Vectors& n, const Read& read) {
    const Floats d;
    const V one = hn::Set(d, 1.0f);
    const V inverse = read(6), lx = read(3), ly = read(4), lz = read(5);
    const V ax = hn::Mul(hn::Sub(at.x, read(0)), inverse), ay = hn::Mul(hn::Sub(at.y, read(1)), inverse),
            az = hn::Mul(hn::Sub(at.z, read(2)), inverse);
    const V out = hn::MulAdd(ax, lx, hn::MulAdd(ay, ly, hn::Mul(az, lz)));
    const V bx = hn::NegMulAdd(lx, out, ax), by = hn::NegMulAdd(ly, out, ay), bz = hn::NegMulAdd(lz, out, az);
    const V aside = hn::Sqrt(hn::MulAdd(bx, bx, hn::MulAdd(by, by, hn::Mul(bz, bz))));
    const V agreement = hn::MulAdd(n.x, lx, hn::MulAdd(n.y, ly, hn::Mul(n.z, lz)));
    return hn::Div(hn::Add(agreement, out), hn::Add(one, aside));
}

void best_pixels(const Coordinates& position, const Coordinates& normal, const std::uint32_t* slot, std::size_t count,
                 const ClusterLines& lines, BestPixel* best) {
    const Floats d;
    const Ints di;
    const V least = hn::Neg(hn::Set(d, std::numeric_limits<float>::infinity()));
    const bool one_vector = lines.size <= hn::Lanes(d) + most_at_once;  // holds all clusters
    each_vector(count, [&](std::size_t begin) HWY_ATTR {
        const auto number = hn::BitCast(di, hn::LoadU(Numbers(), slot + begin));
        const auto in_one = hn::And(hn::Gt(number, hn::Set(di, -1)), hn::FirstN(di, std::min(hn::Lanes(d), count - begin)));
        if (hn::AllFalse(di, in_one)) return;
        const auto of = hn::IfThenElseZero(in_one, number);
        const auto read = [&](std::size_t part) HWY_ATTR {
            const float* from = lines.of.data() + part * lines.size;
            return one_vector ? hn::TableLookupLanes(hn::LoadU(d, from), hn::IndicesFromVec(d, of))
                              : hn::GatherIndex(d, from, of);
        };
        const V score = scores(Vectors(position, begin), Vectors(normal, begin), read);
        const auto* slots = reinterpret_cast<const std::int32_t*>(slot + begin);
        each_number(number, slots, in_one, [&](auto same, std::size_t shared) HWY_ATTR {
            const auto better = hn::And(hn::RebindMask(d, same), hn::Gt(score, hn::Set(d, best[shared].score)));
            if (hn::AllFalse(d, better)) return;
            const V most = hn::MaxOfLanes(d, hn::IfThenElse(better, score, least));
            const std::size_t first = hn::FindKnownFirstTrue(d, hn::And(better, hn::Eq(score, most)));
            best[shared] = {hn::GetLane(most), static_cast<std::uint32_t>(begin + first)};
        });
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(copy_vectors);
HWY_EXPORT(copy_numbers);
HWY_EXPORT(count_normals);
HWY_EXPORT(first_largest);
HWY_EXPORT(nearest_axes);
HWY_EXPORT(slice_depths);
HWY_EXPORT(best_pixels);

void copy_vectors(std::span<const vec3> from, const Rows& rows, Coordinates& to) {
    HWY_DYNAMIC_DISPATCH(copy_vectors)(from, rows, to);
}
void copy_numbers(std::span<const float> from, const Rows& rows, std::vector<float>& to) {
    HWY_DYNAMIC_DISPATCH(copy_numbers)(from, rows, to);
}
void count_normals(const Coordinates& normal, const float* depth, std::size_t count, int bins, float* histogram) {
    HWY_DYNAMIC_DISPATCH(count_normals)(normal, depth, count, bins, histogram);
}
std::size_t first_largest(const float* numbers, std::size_t count) { return HWY_DYNAMIC_DISPATCH(first_largest)(numbers, count); }
void nearest_axes(const Coordinates& normal, std::size_t count, const std::array<vec3, 3>& axes, std::uint32_t* axis) {
    HWY_DYNAMIC_DISPATCH(nearest_axes)(normal, count, axes, axis);
}
void slice_depths(const float* distance, std::size_t count, float inverse_near, float an_octave, std::uint32_t* slice) {
    HWY_DYNAMIC_DISPATCH(slice_depths)(distance, count, inverse_near, an_octave, slice);
}
void best_pixels(const Coordinates& position, const Coordinates& normal, const std::uint32_t* slot, std::size_t count,
                 const ClusterLines& lines, BestPixel* best) {
    HWY_DYNAMIC_DISPATCH(best_pixels)(position, normal, slot, count, lines, best);
}

}  // namespace interreflect
#endif
