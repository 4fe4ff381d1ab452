#include "reference/glossy_lanes.h"

#include "shading/brdf.h"

namespace interreflect {
namespace {

/// Calls body(lane, number of the path) for the lanes that have a lobe.
template <class Body>
void for_each_glossy(const PathLanes& paths, std::uint32_t first, int lanes, const Body& body) {
    for (int k = 0; k < lanes; ++k)
        if (first + k < paths.count && paths.lobe[first + k] != SurfacePacket::no_lobe) body(k, first + k);
}

}  // namespace

SurfacePoint PathLanes::surface(std::uint32_t i, std::span<const Material> materials) const {
    SurfacePoint point;
    point.position = position.at(i);
    point.geometric_normal = geometric_normal.at(i);
    point.normal = normal.at(i);
    point.albedo = albedo.at(i);
    point.offset = offset[i];
    if (lobe[i] == SurfacePacket::no_lobe) return point;
    const Material& material = materials[lobe[i]];
    point.specular = material.specular;
    point.alpha = material.alpha;
    point.exponent = material.exponent;
    point.lobe = material.lobe;
    return point;
}

void evaluate_glossy(const PathLanes& paths, std::span<const Material> materials, std::uint32_t first, int lanes,
                     GlossyLanes& g) {
    for_each_glossy(paths, first, lanes, [&](int lane, std::uint32_t path) {
        const BrdfValue f = evaluate_brdf_and_pdf(paths.surface(path, materials), -paths.direction.at(path), g.at(lane));
        g.set_value(lane, f.value);
        g.pdf[lane] = f.pdf;
    });
}

void sample_glossy(const PathLanes& paths, std::span<const Material> materials, std::uint32_t first, int lanes,
                   const float* choose, const float* u, const float* v, GlossyLanes& g) {
    for_each_glossy(paths, first, lanes, [&](int lane, std::uint32_t path) {
        const BrdfSample next =
            sample_brdf(paths.surface(path, materials), -paths.direction.at(path), choose[lane], {u[lane], v[lane]});
        for (int axis = 0; axis < 3; ++axis) g.direction[axis][lane] = next.wi[axis];
        g.set_value(lane, next.weight);
        g.pdf[lane] = next.pdf;
    });
}

}  // namespace interreflect
