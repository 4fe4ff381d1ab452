/// What pixels get from a light volume.
#pragma once
#include "data/gathered_light.h"
#include "data/gbuffer.h"
#include "data/light_volume.h"

namespace interreflect {

/// Irradiance alone: the intensity against a pixel's normal, interpolated between the eight cells around it, as if it stood
/// `distance` cells away and straight before the surface [Kaplanyan and Dachsbacher 2010, 3.4: half a cell]. What light has gone
/// by is not known: light from one side comes to 3/4 / (pi distance^2) of what it is, .955 for half a cell. Negative values are
/// 0, and so is light outside of the grid.
GatheredLight look_up(const LightVolume& volume, const GBuffer& gbuffer);

}  // namespace interreflect
