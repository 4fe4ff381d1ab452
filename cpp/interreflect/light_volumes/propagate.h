/// Propagate: how does injected light spread through the cells of a grid?
///
///   LightVolume propagate(const Technique&, const LightVolume& injected, const GeometryVolume* blockers);
///
/// The volume holds what has come to each cell from others; what was injected has not come to anything yet. No counterpart is
/// exact: in a grid of two bands light spreads but by spreading. Whole pictures are compared with traced ones.
#pragma once
#include <variant>

#include "light_volumes/propagate/light_propagation.h"

namespace interreflect {
using Propagate = std::variant<LightPropagation>;
}
