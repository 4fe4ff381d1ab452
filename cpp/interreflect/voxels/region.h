/// Region: which part of space do the voxels cover?
///
/// Cones that leave it see the environment. Grid's `region`; view volumes (Perspective, Spherical) bring their own.
#pragma once
#include <variant>

#include "voxels/region/around_camera.h"
#include "voxels/region/box.h"
#include "voxels/region/scene_bounds.h"

namespace interreflect {
using Region = std::variant<SceneBounds, Box, AroundCamera>;
}
