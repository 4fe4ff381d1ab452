#include "voxels/glossy/reflections.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels/glossy/reflections.cpp"
#include <hwy/foreach_target.h>
// clang-format off
#include <hwy/highway.h>
// clang-format on

#include "voxels/glossy/lobe_lanes-inl.h"

// Roofline: twenty gathers from a table of 20 KiB for sixteen pixels, some 25 cycles a pixel.
HWY_BEFORE_NAMESPACE();
namespace interreflect {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The last vector may reach beyond `count`: its other lanes see the first pixel's lobe, and are never read.
void find_lanes(const LobeTables& tables, const vec3& eye, bool mirrored, Reflections& of) {
    const Tag d;
    const hn::RebindToSigned<Tag> di;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int i = of.count; i % lanes != 0; ++i) of.table[i] = of.table[0];
    for (int i = 0; i < of.count; i += lanes) {
        const Vec3 position{hn::Load(d, of.position[0] + i), hn::Load(d, of.position[1] + i), hn::Load(d, of.position[2] + i)};
        const Vec3 normal{hn::Load(d, of.normal[0] + i), hn::Load(d, of.normal[1] + i), hn::Load(d, of.normal[2] + i)};
        const SeenFrom seen(eye, position, normal);
        const LobeLookUp lobe(tables.entries(), hn::Load(di, of.table + i), hn::Load(d, of.alpha + i), seen.cosine);
        // The mirrored view's part along the surface; seen from straight above there is none.
        const Vec3 across = moved(negated(seen.view), normal, seen.cosine);
        const Vector length = hn::Sqrt(dot(across, across)), least = hn::Set(d, 1e-6f);
        const Vector inverse = hn::IfThenElseZero(hn::Gt(length, least), hn::Div(hn::Set(d, 1.0f), hn::Max(length, least)));
        const Vector along = mirrored ? length : lobe.along(), up = mirrored ? seen.cosine : lobe.up();
        const Vec3 mean = moved(scaled(normal, up), across, hn::Mul(inverse, along));
        const Vec3 unit = scaled(mean, hn::Div(hn::Set(d, 1.0f), hn::Sqrt(dot(mean, mean))));
        hn::Store(unit.x, d, of.direction[0] + i);
        hn::Store(unit.y, d, of.direction[1] + i);
        hn::Store(unit.z, d, of.direction[2] + i);
        hn::Store(lobe.half_angle(), d, of.half_angle + i);
        hn::Store(lobe.scale(), d, of.scale + i);
        hn::Store(lobe.bias(), d, of.bias + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace interreflect
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace interreflect {

HWY_EXPORT(find_lanes);

void find_lobes(const LobeTables& tables, const vec3& eye, bool mirrored, Reflections& of) {
    HWY_DYNAMIC_DISPATCH(find_lanes)(tables, eye, mirrored, of);
}

}  // namespace interreflect
#endif
