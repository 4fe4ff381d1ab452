/// The reflection of SCENE_FORMAT.md, f = albedo / pi + one glossy lobe, and the lobes that stage shade puts in its place.
///
/// `wo` and `wi` are unit vectors that leave the surface, in world space: towards the viewer and towards the light.
#pragma once
#include "math/vectors.h"
#include "visibility/surface.h"

namespace interreflect {

/// f(wo, wi), 1/sr, without the cosine; 0 unless both directions are above the geometric and the shading horizon.
vec3 evaluate_brdf(const SurfacePoint& point, const vec3& wo, const vec3& wi);

/// The same over light that fills a circle of `solid_angle` about wi evenly: the mean of f. GGX's slopes over a circle in closed
/// form, exact but for the circle's shape among half vectors and for shadowing, which is that of its middle; of lobes with an
/// exponent, one as high as the mean is in their middle.
vec3 mean_brdf(const SurfacePoint& point, const vec3& wo, const vec3& wi, float solid_angle);

/// Solid angle density of sample_brdf, 1/sr, over the whole sphere: it integrates to 1, or is 0 where nothing is reflected.
float brdf_pdf(const SurfacePoint& point, const vec3& wo, const vec3& wi);

struct BrdfSample {
    vec3 wi{0};
    vec3 weight{0};  // f cos / pdf; 0 where `wi` lies below a horizon
    float pdf = 0;   // 0: nothing is reflected towards wo
};
/// Chooses a lobe in proportion to its luminance with `choose`, and a direction with `u`; both uniform in [0, 1).
BrdfSample sample_brdf(const SurfacePoint& point, const vec3& wo, float choose, const vec2& u);

/// Density and value together, for a direction that something else chose.
struct BrdfValue {
    vec3 value{0};
    float pdf = 0;
};
BrdfValue evaluate_brdf_and_pdf(const SurfacePoint& point, const vec3& wo, const vec3& wi);

}  // namespace interreflect
