#pragma once
#include "voxels/warp/view_volume.h"

namespace interreflect {

/// The view volume in spherical coordinates about the eye: azimuth, elevation and the logarithm of the distance, so voxels are
/// curved and about as deep as wide. With `snap` the angles are those of the world in whole steps: voxels then stay where they
/// are while the camera turns about its place.
struct Spherical : ViewVolume {
    bool snap = true;

    bool operator==(const Spherical&) const = default;
    static constexpr auto description =
        describe("Spherical", "The view volume in azimuth, elevation and logarithm of the distance: curved frustum voxels.",
                 Source{"after Freed 2018", "5.4"}, ViewVolume::params,
                 Param{"snap", &Spherical::snap, "whether the volume turns in whole voxels only"});
};

}  // namespace interreflect
