/// The knobs of the warps that map what the camera sees onto the grid.
#pragma once
#include "data/technique.h"

namespace interreflect {

struct ViewVolume {
    double near = 0.02;
    double far = 0.0;
    double widening = 1.25;

    bool operator==(const ViewVolume&) const = default;
    static constexpr auto params =
        std::tuple{Param{"near", &ViewVolume::near, "where voxels begin before the eye", Unit::extents, above_up_to(0, 10)},
                   Param{"far", &ViewVolume::far, "where they end; 0: as far away as the scene's farthest corner", Unit::extents,
                         between(0, 100)},
                   Param{"widening", &ViewVolume::widening,
                         "width of the volume as a multiple of the picture's: light from outside of it is lost, and cones that "
                         "leave it are open (see "
                         "the sky by rays, TracedSky, where walls lie outside)",
                         Unit::none, between(1, 20)}};
};

}  // namespace interreflect
