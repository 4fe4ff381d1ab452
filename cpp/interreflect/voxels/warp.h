/// Warp: how are a grid's voxels spread over space?
///
///   Warp placed(const Technique&, ...) in grid.cpp; data/warp.h has the maps.
///
/// Separable warps map the region onto itself axis by axis and are densest at the camera's coordinates; view volumes bring their
/// own region. No exact counterpart: traced rays of the march bypass the grid.
#pragma once
#include <variant>

#include "voxels/warp/cubic_spline.h"
#include "voxels/warp/linear.h"
#include "voxels/warp/logistic.h"
#include "voxels/warp/perspective.h"
#include "voxels/warp/spherical.h"

namespace interreflect {
using WarpTechnique = std::variant<Linear, Logistic, CubicSpline, Perspective, Spherical>;
}
