/// Light from one direction, and what a pixel makes of it by its own BRDF.
#pragma once
#include "direct/pixel_surface.h"
#include "shading/brdf.h"

namespace interreflect {

/// Radiance times solid angle, from one direction.
struct Beam {
    vec3 direction{0}, light{0};
};

/// Sums of a pixel's irradiance and of what its lobe reflects.
struct Reflected {
    vec3 irradiance{0}, glossy{0};

    void add(const PixelSurface& surface, const Beam& beam, float weight) {
        const float cosine = glm::dot(surface.point.normal, beam.direction);
        if (!(cosine > 0.0f)) return;
        irradiance += beam.light * (weight * cosine);
        if (!surface.glossy()) return;
        SurfacePoint lobe = surface.point;
        lobe.albedo = vec3(0);
        glossy += evaluate_brdf(lobe, surface.to_viewer, beam.direction) * beam.light * (weight * cosine);
    }
};

}  // namespace interreflect
