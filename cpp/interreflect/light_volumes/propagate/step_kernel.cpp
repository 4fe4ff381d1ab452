#include "light_volumes/propagate/step_kernel.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light_volumes/propagate/step_kernel.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "math/lanes-inl.h"

// Roofline: a cell is 48 bytes, read once and written once beside as much of the sum, all in a cache of the processor for grids
// of 32^3; six neighbours send through five faces each, at about eight operations a face and colour.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Of the four planes of a colour: number of the harmonic that goes with each axis.
constexpr int along[3] = {3, 1, 2};

struct Constants {
    // What the faces of a neighbouring cell take up of the directions from a cell's middle, sr: the far one, and each of four at
    // its sides. Six neighbours together: all directions, 4 pi. The paper prints .4007 and .4234.
    float front_angle = 4.0f * std::atan(0.25f / (1.5f * std::sqrt(2.75f)));
    float side_angle = (2.0f / 3.0f * pi - front_angle) / 4.0f;
    // The middle of a side is seen along (2, 1, 0) / sqrt(5).
    float towards = 2.0f / std::sqrt(5.0f), sideways = 1.0f / std::sqrt(5.0f);
    float y0 = std::sqrt(0.25f / pi), y1 = std::sqrt(0.75f / pi);  // of a direction
    float lobe0 = y0, lobe1 = std::sqrt(1.0f / (3.0f * pi));       // of flux / pi times a clamped cosine
};

/// Along the five directions from a neighbour's middle to the far faces of a cell.
struct Five {
    Vector front, left, right, up, down;
};

/// A function of two bands there. c: its four harmonics; a, b, e: which of them goes with the way and with the two axes across.
HWY_INLINE Five evaluated(const Vector* c, int a, int b, int e, float sign, const Constants& k) {
    const Tag d;
    const Vector mean = hn::Mul(hn::Set(d, k.y0), c[0]), ahead = hn::Mul(hn::Set(d, sign * k.y1), c[a]);
    const Vector aside = hn::Mul(hn::Set(d, k.sideways * k.y1), c[b]), above = hn::Mul(hn::Set(d, k.sideways * k.y1), c[e]);
    const Vector middle = hn::MulAdd(hn::Set(d, k.towards), ahead, mean);
    return {hn::Add(mean, ahead), hn::Add(middle, aside), hn::Sub(middle, aside), hn::Add(middle, above), hn::Sub(middle, above)};
}

template <class Change>
HWY_INLINE Five changed(const Five& a, const Change& change) {
    return {change(a.front), change(a.left), change(a.right), change(a.up), change(a.down)};
}

/// The share that is not blocked, of light along a way.
HWY_INLINE Five open_share(const StepRow& row, int axis, int sign, int x, const Constants& k) {
    const Tag d;
    Vector c[4];
    for (int i = 0; i < 4; ++i) c[i] = hn::LoadU(d, row.faces[axis][i] + (sign < 0 ? row.face_step[axis] : 0) + x);
    // Seen from where light comes: against its way.
    for (int i = 1; i < 4; ++i) c[i] = hn::Neg(c[i]);
    const Five blocked = evaluated(c, along[axis], along[(axis + 1) % 3], along[(axis + 2) % 3], static_cast<float>(sign), k);
    const Vector none = hn::Zero(d), all = hn::Set(d, 1.0f);
    return changed(blocked, [&](Vector b) { return hn::Sub(all, hn::Min(hn::Max(b, none), all)); });
}

template <bool clamps, bool blocks>
HWY_INLINE void receive(const StepRow& row, int axis, int sign, int x, const Constants& k, Vector* to) {
    const Tag d;
    const int a = along[axis], b = along[(axis + 1) % 3], e = along[(axis + 2) % 3];
    Five open{};
    if constexpr (blocks) open = open_share(row, axis, sign, x, k);
    const std::ptrdiff_t place = x - sign * row.step[axis];
    const Vector front_angle = hn::Set(d, k.front_angle), side_angle = hn::Set(d, k.side_angle), none = hn::Zero(d);
    for (int colour = 0; colour < Planes::count; colour += LightVolume::harmonics) {
        Vector c[4];
        for (int i = 0; i < 4; ++i) c[i] = hn::LoadU(d, row.before[colour + i] + place);
        Five flux = evaluated(c, a, b, e, static_cast<float>(sign), k);
        if constexpr (clamps) flux = changed(flux, [&](Vector f) { return hn::Max(f, none); });
        if constexpr (blocks)
            flux = {hn::Mul(flux.front, open.front), hn::Mul(flux.left, open.left), hn::Mul(flux.right, open.right),
                    hn::Mul(flux.up, open.up), hn::Mul(flux.down, open.down)};
        const Vector front = hn::Mul(flux.front, front_angle);
        const Vector sides = hn::Add(hn::Add(flux.left, flux.right), hn::Add(flux.up, flux.down));
        Vector* const sum = to + colour;
        sum[0] = hn::MulAdd(hn::Set(d, k.lobe0), hn::MulAdd(side_angle, sides, front), sum[0]);
        sum[a] = hn::MulAdd(hn::Set(d, static_cast<float>(sign) * k.lobe1), front, sum[a]);
        const Vector lobe = hn::Set(d, k.lobe1 * k.side_angle);
        sum[b] = hn::MulAdd(lobe, hn::Sub(flux.left, flux.right), sum[b]);
        sum[e] = hn::MulAdd(lobe, hn::Sub(flux.up, flux.down), sum[e]);
    }
}

template <bool clamps, bool blocks>
void step_cells(const StepRow& row) {
    const Tag d;
    constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
    static_assert(lanes <= static_cast<int>(row_slack));
    static const Constants constants;
    const Constants k = constants;
    for (int x = 0; x < row.cells; x += lanes) {
        Vector to[Planes::count];
        for (Vector& one : to) one = hn::Zero(d);
        for (int axis = 0; axis < 3; ++axis) {
            receive<clamps, blocks>(row, axis, 1, x, k, to);
            receive<clamps, blocks>(row, axis, -1, x, k, to);
        }
        // The border behind the row's end stays air.
        const auto inside = hn::FirstN(d, static_cast<std::size_t>(row.cells - x));
        for (int plane = 0; plane < Planes::count; ++plane) {
            const Vector kept = hn::IfThenElseZero(inside, to[plane]);
            hn::StoreU(kept, d, row.after[plane] + x);
            hn::StoreU(hn::Add(hn::LoadU(d, row.sum[plane] + x), kept), d, row.sum[plane] + x);
        }
    }
}

void StepCells(const StepRow& row) {
    if (row.faces[0][0] != nullptr)
        row.clamps ? step_cells<true, true>(row) : step_cells<false, true>(row);
    else
        row.clamps ? step_cells<true, false>(row) : step_cells<false, false>(row);
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(StepCells);

void step_row(const StepRow& row) { HWY_DYNAMIC_DISPATCH(StepCells)(row); }
}  // namespace interreflect
#endif
