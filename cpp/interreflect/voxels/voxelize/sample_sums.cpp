#include "voxels/voxelize/sample_sums.h"

#include "voxels/voxelize/nearest_texel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/voxelize/sample_sums.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "voxels/voxelize/texel_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

/// Rounded step by step: which cell a sample falls into must not hang on the processor.
HWY_INLINE Vector interpolated(float at_corner, float first, float second, Vector a, Vector b) {
    const Tag d;
    return hn::Add(hn::Set(d, at_corner), hn::Add(hn::Mul(hn::Set(d, first), a), hn::Mul(hn::Set(d, second), b)));
}

void sum_samples_lanes(const SampledSurface& s, const SampleWeights& weights, int count, SampleSums& sums) {
    const Tag d;
    const IntTag di;
    const TexelLanes texels{s.srgb, hn::Zero(di), hn::Set(di, s.width), hn::Set(di, s.height)};
    for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
        const Vector a = hn::LoadU(d, weights.second + i), b = hn::LoadU(d, weights.third + i);
        const Vector area = hn::Mul(hn::LoadU(d, weights.area + i), hn::Set(d, weights.scale));
        const Vec3 position{interpolated(s.corner.x, s.edge[0].x, s.edge[1].x, a, b),
                            interpolated(s.corner.y, s.edge[0].y, s.edge[1].y, a, b),
                            interpolated(s.corner.z, s.edge[0].z, s.edge[1].z, a, b)};
        Vec3 albedo{hn::Set(d, s.albedo.r), hn::Set(d, s.albedo.g), hn::Set(d, s.albedo.b)};
        if (s.srgb != nullptr) {
            const Vector u = interpolated(s.texcoord.x, s.texcoord_edge[0].x, s.texcoord_edge[1].x, a, b);
            const Vector v = interpolated(s.texcoord.y, s.texcoord_edge[0].y, s.texcoord_edge[1].y, a, b);
            albedo = product(albedo, texels.at(u, v));
        }
        store_sums(position, area, albedo, s.cells, i, sums);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(sum_samples_lanes);

void sum_samples(const SampledSurface& surface, const SampleWeights& weights, int count, SampleSums& sums) {
    HWY_DYNAMIC_DISPATCH(sum_samples_lanes)(surface, weights, count, sums);
}
}  // namespace interreflect
#endif
