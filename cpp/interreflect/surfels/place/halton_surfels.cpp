#include "surfels/place/halton_surfels.h"

#include "math/radical_inverse.h"
#include "surfels/place/point_on_surface.h"

namespace interreflect {

Surfels place_surfels(const HaltonSurfels& technique, const Scene& scene, const Intersector&) {
    return surfels_by_area(scene, technique.surfels, [](std::uint32_t number) {
        return vec2(radical_inverse(2, number + 1), radical_inverse(3, number + 1));
    });
}

}  // namespace interreflect
