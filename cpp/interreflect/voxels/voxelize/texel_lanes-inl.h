// Samples as vectors: their nearest texels, and what they are worth to their cells. Included once for every vector target.
#if defined(INTERREFLECT_TEXEL_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef INTERREFLECT_TEXEL_LANES
#undef INTERREFLECT_TEXEL_LANES
#else
#define INTERREFLECT_TEXEL_LANES
#endif

#include "math/lanes-inl.h"
#include "voxels/voxelize/nearest_texel.h"
#include "voxels/voxelize/sample_sums.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using IntTag = hn::RebindToSigned<Tag>;
using IntVector = hn::Vec<IntTag>;

HWY_INLINE Vec3 product(const Vec3& a, const Vec3& b) { return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)}; }

/// NearestTexel of one sRGB texture, each lane in a mip level of its own.
struct TexelLanes {
    const std::uint32_t* srgb;
    IntVector first, width, height;

    static HWY_INLINE IntVector place(Vector coordinate, IntVector size) {
        const Tag d;
        const IntTag di;
        const Vector f = hn::Sub(coordinate, hn::Floor(coordinate));  // 1 where a tiny negative coordinate is rounded
        const IntVector at = hn::Min(hn::ConvertTo(di, hn::Mul(f, hn::ConvertTo(d, size))), hn::Sub(size, hn::Set(di, 1)));
        return hn::IfThenElseZero(hn::RebindMask(di, hn::Lt(f, hn::Set(d, 1.0f))), at);
    }
    HWY_INLINE Vec3 at(Vector u, Vector v) const {
        const Tag d;
        const IntTag di;
        const IntVector index = hn::Add(first, hn::Add(hn::Mul(place(v, height), width), place(u, width)));
        const IntVector texel = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(srgb), index);
        const IntVector byte = hn::Set(di, 255);
        const float* values = linear_values.data();
        return {hn::GatherIndex(d, values, hn::And(texel, byte)),
                hn::GatherIndex(d, values, hn::And(hn::ShiftRight<8>(texel), byte)),
                hn::GatherIndex(d, values, hn::And(hn::ShiftRight<16>(texel), byte))};
    }
};

/// Puts solid samples in the places from `i` on; `position` in voxels.
HWY_INLINE void store_sums(const Vec3& position, Vector area, const Vec3& albedo, const ivec3& cells, int i, SampleSums& sums) {
    const Tag d;
    const IntTag di;
    const Vec3 floor{hn::Floor(position.x), hn::Floor(position.y), hn::Floor(position.z)};
    const auto within = [&](Vector f, int size)
                            HWY_ATTR { return hn::And(hn::Ge(f, hn::Zero(d)), hn::Lt(f, hn::Set(d, static_cast<float>(size)))); };
    const LaneMask inside = hn::And(hn::And(within(floor.x, cells.x), within(floor.y, cells.y)), within(floor.z, cells.z));
    const IntVector column = hn::Add(hn::ConvertTo(di, floor.y), hn::Mul(hn::ConvertTo(di, floor.z), hn::Set(di, cells.y)));
    const IntVector cell = hn::Add(hn::ConvertTo(di, floor.x), hn::Mul(column, hn::Set(di, cells.x)));
    const IntVector outside = hn::Set(di, static_cast<std::int32_t>(SampleSums::outside));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(di, inside), cell, outside), di, reinterpret_cast<std::int32_t*>(&sums.cell[i]));
    const auto local = [&](Vector p, Vector f) HWY_ATTR { return hn::Mul(hn::Sub(hn::Sub(p, f), hn::Set(d, 0.5f)), area); };
    hn::StoreInterleaved4(hn::Mul(albedo.x, area), hn::Mul(albedo.y, area), hn::Mul(albedo.z, area), area, d,
                          sums.albedo[i].data());
    hn::StoreInterleaved4(local(position.x, floor.x), local(position.y, floor.y), local(position.z, floor.z), area, d,
                          sums.position[i].data());
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#endif
