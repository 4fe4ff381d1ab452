#include "shading/share/interleaved.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/share/interleaved.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "shading/share/same_surface-inl.h"

// Compiled once for every vector width; the widest that the machine has is chosen at run time.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int padded = merge_tile_size + 2 * largest_halo, pad_row = padded + 16;

/// A tile with its halo in parallel planes, so that a tap is an offset.
struct Planes {
    enum { px, py, pz, nx, ny, nz, r, g, b, a, weight, count };
    alignas(64) float plane[count][padded * pad_row + 64];
};

/// Spreads the pixels [x0, x1) of one row over the planes from `at` on. Those that hit nothing get normal 0, which no test
/// passes.
void load_row(const GBuffer& gbuffer, const Buffer<vec4>& partial, std::size_t row, int x0, int x1, int at, Planes& to) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const auto* position = reinterpret_cast<const float*>(gbuffer.position.data() + row);
    const auto* normal = reinterpret_cast<const float*>(gbuffer.normal.data() + row);
    const auto* value = reinterpret_cast<const float*>(partial.data() + row);
    int x = x0;
    for (; x < x1 && x + lanes <= gbuffer.width; x += lanes) {
        const int to_at = at + x - x0;
        const auto hit = hn::RebindMask(d, hn::Ne(hn::LoadU(du, gbuffer.triangle.data() + row + x), hn::Set(du, no_hit)));
        auto a = hn::Zero(d), b = a, c = a, e = a;
        const auto keep = [&](int plane, decltype(a) v)
                              HWY_ATTR { hn::StoreU(hn::IfThenElseZero(hit, v), d, to.plane[plane] + to_at); };
        hn::LoadInterleaved3(d, position + 3 * x, a, b, c);
        keep(Planes::px, a), keep(Planes::py, b), keep(Planes::pz, c);
        hn::LoadInterleaved3(d, normal + 3 * x, a, b, c);
        keep(Planes::nx, a), keep(Planes::ny, b), keep(Planes::nz, c);
        hn::LoadInterleaved4(d, value + 4 * x, a, b, c, e);
        keep(Planes::r, a), keep(Planes::g, b), keep(Planes::b, c), keep(Planes::a, e);
    }
    for (; x < x1; ++x) {
        const bool hit = gbuffer.triangle[row + x] != no_hit;
        for (int k = 0; k < 3; ++k) {
            to.plane[Planes::px + k][at + x - x0] = hit ? position[3 * x + k] : 0.0f;
            to.plane[Planes::nx + k][at + x - x0] = hit ? normal[3 * x + k] : 0.0f;
        }
        for (int k = 0; k < 4; ++k) to.plane[Planes::r + k][at + x - x0] = hit ? value[4 * x + k] : 0.0f;
    }
}

/// A tile and its halo; outside the picture normals are 0.
void load_tile(const InterleavedMerge& merge, const Tile& tile, Planes& to) {
    const GBuffer& gbuffer = merge.gbuffer;
    const int block_width = merge.share.width, block_height = merge.share.height;
    const int halo = std::max(block_width, block_height) / 2;
    const int left = tile.x0 - halo < 0 ? 0 : tile.x0 - halo;
    const int right = tile.x1 + halo > gbuffer.width ? gbuffer.width : tile.x1 + halo;
    for (int y = tile.y0 - halo; y < tile.y1 + halo; ++y) {
        const int row = (y - tile.y0 + largest_halo) * pad_row + largest_halo - tile.x0;  // planes' index of x = 0
        const bool inside = y >= 0 && y < gbuffer.height;
        if (inside) load_row(gbuffer, merge.partial, static_cast<std::size_t>(y) * gbuffer.width, left, right, row + left, to);
        const auto clear = [&](int x) {
            for (int plane = Planes::nx; plane < Planes::count; ++plane) to.plane[plane][row + x] = 0.0f;
        };
        for (int x = tile.x0 - halo; x < (inside ? left : tile.x1 + halo); ++x) clear(x);
        for (int x = inside ? right : tile.x1 + halo; x < tile.x1 + halo; ++x) clear(x);
        if (!inside) continue;
        const float* row_weights = merge.weights.data() + block_width * (y % block_height);
        for (int x = left, phase = left % block_width; x < right; ++x) {
            to.plane[Planes::weight][row + x] = row_weights[phase];
            phase = phase + 1 == block_width ? 0 : phase + 1;
        }
    }
}

HWY_INLINE Vec3 load3(const Planes& from, int plane, int at) {
    const Tag d;
    return {hn::LoadU(d, from.plane[plane] + at), hn::LoadU(d, from.plane[plane + 1] + at),
            hn::LoadU(d, from.plane[plane + 2] + at)};
}

/// Merges a vector of pixels at `at`.
void merge_vector(const Planes& from, int at, const Window& window, const OwnSurface& own, float* out) {
    const Tag d;
    const auto phases = static_cast<int>(window.first.size()) - 1;
    const Vector zero = hn::Zero(d);
    Vector sum[4] = {zero, zero, zero, zero}, available = zero;
    for (int phase = 0; phase < phases; ++phase) {
        Vector part[4] = {zero, zero, zero, zero}, norm = zero, weight = zero;
        for (int t = window.first[phase]; t < window.first[phase + 1]; ++t) {
            const int there = at + window.taps[t].dx + pad_row * window.taps[t].dy;
            const auto same = own.holds(load3(from, Planes::px, there), load3(from, Planes::nx, there));
            const Vector w = hn::IfThenElseZero(same, hn::Set(d, window.taps[t].weight));
            norm = hn::Add(norm, w);
            weight = hn::IfThenElse(same, hn::LoadU(d, from.plane[Planes::weight] + there), weight);
            for (int c = 0; c < 4; ++c) part[c] = hn::MulAdd(w, hn::LoadU(d, from.plane[Planes::r + c] + there), part[c]);
        }
        const Vector scale = hn::IfThenElseZero(hn::Gt(norm, zero), hn::Div(hn::Set(d, 1.0f), hn::Max(norm, hn::Set(d, 1e-6f))));
        for (int c = 0; c < 4; ++c) sum[c] = hn::MulAdd(part[c], scale, sum[c]);
        available = hn::Add(available, weight);
    }
    const Vector scale =
        hn::IfThenElseZero(hn::Gt(available, zero), hn::Div(hn::Set(d, 1.0f), hn::Max(available, hn::Set(d, 1e-6f))));
    hn::StoreInterleaved4(hn::Mul(sum[0], scale), hn::Mul(sum[1], scale), hn::Mul(sum[2], scale), hn::Mul(sum[3], scale), d, out);
}

void merge_tile(const InterleavedMerge& merge, const Tile& tile, vec4* merged) {
    const Tag d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    thread_local Planes planes;
    const GBuffer& gbuffer = merge.gbuffer;
    load_tile(merge, tile, planes);
    const SharedAngles angles(merge.share, gbuffer);
    const vec3 eye = gbuffer.camera.position;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; x += lanes) {
            const int at = (y - tile.y0 + largest_halo) * pad_row + largest_halo + x - tile.x0;
            const Vec3 position = load3(planes, Planes::px, at);
            const Vec3 away{hn::Sub(position.x, hn::Set(d, eye.x)), hn::Sub(position.y, hn::Set(d, eye.y)),
                            hn::Sub(position.z, hn::Set(d, eye.z))};
            const OwnSurface own(angles, position, load3(planes, Planes::nx, at), hn::Sqrt(dot(away, away)));
            merge_vector(planes, at, merge.window, own, &merged[(y - tile.y0) * merge_tile_size + x - tile.x0].x);
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(merge_tile);

Window::Window(int width, int height) {
    for (int phase = 0; phase < width * height; ++phase) {
        first.push_back(static_cast<int>(taps.size()));
        for (int dy = -(height / 2); dy <= height / 2; ++dy)
            for (int dx = -(width / 2); dx <= width / 2; ++dx) {
                if ((dx + width) % width != phase % width || (dy + height) % height != phase / width) continue;
                const bool x_end = 2 * std::abs(dx) == width, y_end = 2 * std::abs(dy) == height;
                taps.push_back({dx, dy, (x_end ? 0.5f : 1.0f) * (y_end ? 0.5f : 1.0f)});
            }
    }
    first.push_back(static_cast<int>(taps.size()));
}

void InterleavedMerge::tile(const Tile& tile, vec4* merged) const { HWY_DYNAMIC_DISPATCH(merge_tile)(*this, tile, merged); }

}  // namespace interreflect
#endif
