#include "shading/emitter_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shading/emitter_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "shading/emitter_kernel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {

void sample_batch(const EmitterShape* shapes, int count, EmitterBatch& batch) {
    const Tag d;
    alignas(64) float rows[8][EmitterBatch::width];
    for (int k = 0; k < EmitterBatch::width; k += static_cast<int>(hn::Lanes(d))) {
        const Vec3 position{hn::Load(d, batch.position[0] + k), hn::Load(d, batch.position[1] + k),
                            hn::Load(d, batch.position[2] + k)};
        const LightLanes light = sample_shape_lanes(shapes, count, position, hn::Load(d, batch.choose + k),
                                                    hn::Load(d, batch.u + k), hn::Load(d, batch.v + k));
        const Vector columns[8] = {light.direction.x, light.direction.y, light.direction.z, light.distance,
                                   light.radiance.x,  light.radiance.y,  light.radiance.z,  light.pdf};
        for (int row = 0; row < 8; ++row) hn::Store(columns[row], d, rows[row] + k);
    }
    for (int k = 0; k < batch.count; ++k)
        batch.light[k] = {{rows[0][k], rows[1][k], rows[2][k]}, rows[3][k], {rows[4][k], rows[5][k], rows[6][k]}, rows[7][k]};
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {
HWY_EXPORT(sample_batch);

void sample_emitters(const LightSampler& lights, EmitterBatch& batch) {
    const auto shapes = lights.emitter_shapes();
    if (!shapes.empty()) {
        // What lies beyond the entries is read, and not kept.
        for (int k = batch.count; k < EmitterBatch::width; ++k) {
            for (auto& axis : batch.position) axis[k] = 0.0f;
            batch.choose[k] = batch.u[k] = batch.v[k] = 0.5f;
        }
        HWY_DYNAMIC_DISPATCH(sample_batch)(shapes.data(), static_cast<int>(shapes.size()), batch);
        return;
    }
    for (int k = 0; k < batch.count; ++k)
        batch.light[k] = lights.sample_emitter({batch.position[0][k], batch.position[1][k], batch.position[2][k]},
                                               batch.choose[k], {batch.u[k], batch.v[k]});
}
}  // namespace interreflect
#endif
