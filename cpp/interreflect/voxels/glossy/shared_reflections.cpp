#include "voxels/glossy/shared_reflections.h"

#include <algorithm>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/glossy/shared_reflections.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "shading/share/same_surface-inl.h"
#include "voxels/glossy/lobe_lanes-inl.h"

// Roofline. A pixel: 44 bytes of the G-buffer and 10 of its block are read, 24 written (and read before): 100 bytes. Eight
// gathers from the lobe's table for sixteen pixels take as long as moving 30 bytes a pixel.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int most_lanes = HWY_MAX_BYTES / sizeof(float) < 16 ? HWY_MAX_BYTES / sizeof(float) : 16;

/// The pixels [begin, begin + count) of a row, at most a vector.
struct Pixels {
    std::size_t begin;
    int count;

    HWY_INLINE Vector load(const Buffer<float>& from) const {
        const Whole<float> whole(from.data() + begin, count);
        return hn::LoadU(Tag(), whole.values);
    }
    HWY_INLINE Vec3 load(const Buffer<vec3>& from) const {
        const Whole<float> whole(&from[begin].x, 3 * count);
        Vec3 v;
        hn::LoadInterleaved3(Tag(), whole.values, v.x, v.y, v.z);
        return v;
    }
    HWY_INLINE LaneMask differ(const Buffer<std::uint32_t>& from, std::uint32_t value) const {
        const hn::RebindToUnsigned<Tag> du;
        const Whole<std::uint32_t> whole(from.data() + begin, count);
        return hn::RebindMask(Tag(), hn::Ne(hn::LoadU(du, whole.values), hn::Set(du, value)));
    }
    HWY_INLINE void store(const Vec3& v, Buffer<vec3>& to) const {
        if (count == static_cast<int>(hn::Lanes(Tag()))) return store3(v, &to[begin].x);
        alignas(64) float copy[3 * most_lanes];
        store3(v, copy);
        std::memcpy(&to[begin], copy, static_cast<std::size_t>(count) * sizeof(vec3));
    }

  private:
    /// Values that a vector may be read from: what lies behind the row's end is left out.
    template <class T>
    struct Whole {
        alignas(64) T copy[3 * most_lanes];
        const T* values;

        HWY_INLINE Whole(const T* from, int many) : values(from) {
            if (many % static_cast<int>(hn::Lanes(Tag())) == 0) return;
            std::memset(copy, 0, sizeof(copy));
            std::memcpy(copy, from, static_cast<std::size_t>(many) * sizeof(T));
            values = copy;
        }
    };
};

/// How much a block's first pixel counts for one that lies `away` pixels from it, along an axis on which blocks are `size` long.
HWY_INLINE float tent(int away, int size) { return 2 * away < size ? 1.0f : 2 * away == size ? 0.5f : 0.0f; }

/// Of a vector of pixels in a row, from the block of the first of them on: which one each lies in, and how much this one's first
/// pixel counts for it, and the next one's.
struct Columns {
    alignas(64) std::int32_t block[most_lanes];
    alignas(64) float weight[2][most_lanes];

    Columns(int x, int width) {
        for (int i = 0; i < most_lanes; ++i) {
            const int within = (x % width + i) % width;
            block[i] = (x % width + i) / width;
            weight[0][i] = tent(within, width), weight[1][i] = tent(width - within, width);
        }
    }
};

/// What a vector of pixels takes from the blocks about it.
struct Shared {
    Vec3 radiance, sky;
    Vector weight;
};

/// Adds a row of blocks, from `block` on, which counts `row_weight`.
HWY_INLINE void add_blocks(const SharedReflections& from, int row, int block, const Columns& columns, float row_weight,
                           const OwnSurface& own, Vector alpha, Shared& sum) {
    using From = SharedReflections;
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    const auto spread = hn::IndicesFromVec(d, hn::Load(di, columns.block));
    const Vector alike = hn::Mul(alpha, hn::Set(d, 1e-3f));  // widths
    for (int next = 0; next < 2; ++next) {
        const auto entry = [&](int number) HWY_ATTR {
            return hn::TableLookupLanes(hn::LoadU(d, from.plane(number, row) + block + next), spread);
        };
        const auto entry3 = [&](int number) HWY_ATTR { return Vec3{entry(number), entry(number + 1), entry(number + 2)}; };
        const auto as_wide = hn::Le(hn::Abs(hn::Sub(entry(From::alpha), alpha)), alike);
        const auto same = hn::And(as_wide, own.holds(entry3(From::px), entry3(From::nx)));
        const Vector weight = hn::IfThenElseZero(same, hn::Mul(hn::Load(d, columns.weight[next]), hn::Set(d, row_weight)));
        sum.weight = hn::Add(sum.weight, weight);
        sum.radiance = moved(sum.radiance, entry3(From::r), weight);
        if (from.has_sky()) sum.sky = moved(sum.sky, entry3(From::sky_r), weight);
    }
}

/// The entries with which the tables of some pixels begin.
HWY_INLINE LobeLookUp::Indices first_entries(const LobeTables& tables, const Pixels& pixels, std::uint64_t which) {
    alignas(64) std::int32_t first[most_lanes] = {};
    for (; which != 0; which &= which - 1) {
        const int lane = std::countr_zero(which);
        first[lane] = tables.first(pixels.begin + static_cast<std::size_t>(lane));
    }
    return hn::Load(hn::RebindToSigned<Tag>(), first);
}

HWY_INLINE std::uint64_t bits_of(LaneMask mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Tag(), mask, bytes);
    return static_cast<std::uint64_t>(bytes[0]) | (static_cast<std::uint64_t>(bytes[1]) << 8);
}

/// Pixels from x on in row y. Returns which of them must send cones of their own.
HWY_INLINE std::uint64_t finish_vector(const SharedReflections& from, const SharedAngles& angles, const Columns& columns, int x,
                                       int y, const Pixels& pixels, const GBuffer& gbuffer, const LobeTables& tables, float scale,
                                       GlossyLight& light) {
    const Tag d;
    const Vector zero = hn::Zero(d);
    const Vec3 none{zero, zero, zero}, specular = pixels.load(gbuffer.specular);
    const Vector most = hn::Max(hn::Max(specular.x, specular.y), specular.z);
    const auto reflects =
        hn::And(hn::And(pixels.differ(gbuffer.triangle, no_hit), hn::FirstN(d, static_cast<std::size_t>(pixels.count))),
                hn::Gt(most, zero));
    Vec3 radiance = none, sky = none;
    std::uint64_t alone = 0;
    if (const std::uint64_t bits = bits_of(reflects); bits != 0) {
        const Vec3 position = pixels.load(gbuffer.position), normal = pixels.load(gbuffer.normal);
        const Vector alpha = pixels.load(gbuffer.alpha);
        const SeenFrom seen(gbuffer.camera.position, position, normal);
        const OwnSurface own(angles, position, normal, seen.distance);
        Shared sum{none, none, zero};
        const Interleaved& share = from.share();
        const int row = y / share.height, within = y % share.height;
        for (int next = 0; next < 2 && row + next < from.rows(); ++next)
            if (const float weight = tent(next == 0 ? within : share.height - within, share.height); weight > 0.0f)
                add_blocks(from, row + next, x / share.width, columns, weight, own, alpha, sum);
        const auto shares = hn::And(reflects, hn::Gt(sum.weight, zero));
        alone = bits & ~bits_of(shares);
        const LobeLookUp lobe(tables.entries(), first_entries(tables, pixels, bits), alpha, seen.cosine);
        const Vector inverse = hn::IfThenElseZero(shares, hn::Div(hn::Set(d, 1.0f), hn::Max(sum.weight, hn::Set(d, 1e-6f))));
        const Vector lobe_scale = lobe.scale(), bias = lobe.bias();
        const auto reflected = [&](Vector mean, Vector channel) HWY_ATTR {
            return hn::IfThenElseZero(shares, hn::Mul(hn::Mul(mean, inverse), LobeLookUp::albedo(channel, lobe_scale, bias)));
        };
        radiance = scaled(
            {reflected(sum.radiance.x, specular.x), reflected(sum.radiance.y, specular.y), reflected(sum.radiance.z, specular.z)},
            hn::Set(d, scale));
        if (from.has_sky())
            sky = Vec3{reflected(sum.sky.x, specular.x), reflected(sum.sky.y, specular.y), reflected(sum.sky.z, specular.z)};
    }
    pixels.store(radiance, light.radiance);
    pixels.store(sky, light.sky);
    return alone;
}

void finish_tile(const SharedReflections& from, const Tile& tile, const GBuffer& gbuffer, const LobeTables& tables, float scale,
                 GlossyLight& light, Reflections& alone) {
    const int lanes = static_cast<int>(hn::Lanes(Tag()));
    const SharedAngles angles(from.share(), gbuffer);
    for (int x = tile.x0; x < tile.x1; x += lanes) {
        const Columns columns(x, from.share().width);
        for (int y = tile.y0; y < tile.y1; ++y) {
            const Pixels pixels{static_cast<std::size_t>(y) * gbuffer.width + x, tile.x1 - x < lanes ? tile.x1 - x : lanes};
            std::uint64_t left = finish_vector(from, angles, columns, x, y, pixels, gbuffer, tables, scale, light);
            for (; left != 0; left &= left - 1)
                alone.add(gbuffer, tables, pixels.begin + static_cast<std::size_t>(std::countr_zero(left)));
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(finish_tile);

SharedReflections::SharedReflections(const Interleaved& share, const GBuffer& gbuffer, bool sky)
    : share_(share),
      columns_((gbuffer.width + share.width - 1) / share.width),
      rows_((gbuffer.height + share.height - 1) / share.height),
      row_(static_cast<std::size_t>(columns_) + 1 + vector),
      sky_(sky),
      values_(row_ * static_cast<std::size_t>(rows_) * (sky ? planes : planes_without_sky)) {}

void SharedReflections::clear(int row, int begin, int end) {
    const int last = end == columns_ ? static_cast<int>(row_) : end;
    for (int number = 0; number < (sky_ ? planes : planes_without_sky); ++number)
        std::fill(plane(number, row) + begin, plane(number, row) + last, 0.0f);
}

void SharedReflections::enter(int row, int column, const Reflections& seen, int i) {
    const auto put = [&](int first, const vec3& v) {
        for (int k = 0; k < 3; ++k) plane(first + k, row)[column] = v[k];
    };
    put(px, {seen.position[0][i], seen.position[1][i], seen.position[2][i]});
    put(nx, {seen.normal[0][i], seen.normal[1][i], seen.normal[2][i]});
    plane(alpha, row)[column] = seen.alpha[i];
    put(r, seen.radiance[i]);
    if (sky_) put(sky_r, seen.sky[i]);
}

void SharedReflections::finish(const Tile& tile, const GBuffer& gbuffer, const LobeTables& tables, float scale,
                               GlossyLight& light, Reflections& alone) const {
    HWY_DYNAMIC_DISPATCH(finish_tile)(*this, tile, gbuffer, tables, scale, light, alone);
}

}  // namespace interreflect
#endif
