/// The inner loops of the path tracer, as wide as the machine's vectors. Surfaces with a glossy lobe take the scalar functions of
/// brdf.h lane by lane; all else is diffuse and stays in vectors.
#pragma once
#include <span>

#include "data/camera.h"
#include "reference/path_lanes.h"
#include "shading/lights.h"

namespace interreflect {

/// Paths that are connected with a light, and where the shadow rays go.
struct Connecting {
    const PathLanes& paths;
    std::span<const Material> materials;
    bool weighed;       // the reflection's own ray may meet this light too: both share the work [Veach 1997, 9.2]
    bool continue_all;  // that ray is traced from every vertex; else only from glossy ones
    ShadowLanes& shadows;
};

/// Light from one direction of travel.
void connect_directional(const Connecting& c, const vec3& towards, const vec3& irradiance);
/// One sample of few emitters a path.
void connect_shapes(const Connecting& c, std::span<const EmitterShape> shapes, const PairTable& choices, const PairTable& points);
/// One sample a path of an environment that is the same all around, in proportion to the cosine.
void connect_constant_sky(const Connecting& c, const vec3& radiance, const PairTable& points);

/// Samples that something else took, by path; density 0: none.
struct LightColumns {
    Column3 direction{}, radiance{};
    FloatColumn distance{}, pdf{};

    void set(std::uint32_t i, const LightDirection& light) {
        direction.set(i, light.direction), radiance.set(i, light.radiance);
        distance[i] = light.distance, pdf[i] = light.pdf;
    }
};
void connect_given(const Connecting& c, const LightColumns& lights);

/// Every path's next ray. Roulette ends some from its vertex on.
struct Choosing {
    const PathLanes& paths;
    std::span<const Material> materials;
    bool continue_all, roulette;
    const PairTable& reflections;
    const PairTable& choices;    // y: the lobe
    const PairTable& roulettes;  // x
};
void choose_rays(const Choosing& c, StepLanes& steps);

/// Rays through `places` of the pixels of steps.pixel (numbers in the tile whose corner is (x0, y0)), one pattern's place each.
void choose_primary_rays(const CameraRays& camera, int x0, int y0, const PairTable& places, StepLanes& steps);

/// Appends those lanes of a packet of surfaces that reflect, as met by steps [first, first + 16).
void append_paths(const SurfacePacket& surfaces, std::uint32_t lanes, const StepLanes& steps, std::uint32_t first,
                  PathLanes& paths);
/// Paths `order`[0 .. count) in that order.
void reorder_paths(const PathLanes& from, const NumberColumn& order, std::uint32_t count, PathLanes& to);

}  // namespace interreflect
