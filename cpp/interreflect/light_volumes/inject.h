/// Inject: which cells of a grid do virtual lights light first, and where does surface block light?
#pragma once
#include "data/light_volume.h"
#include "data/surfels.h"
#include "data/virtual_lights.h"

namespace interreflect {

/// Each light's flux as a clamped cosine lobe about its normal, half a cell in front of its surface, so that a wall's light does
/// not come back to it [Kaplanyan and Dachsbacher 2010, 3.2; their lobes lack 1/pi].
///
/// It is shared by the eight cells around that place, by distance. The paper puts all of it into one: but a grid about a scene's
/// bounds has outer walls in the middle of cells, so that half a cell before them cells meet, and rounding would choose.
/// Lights outside of the grid are left out, and what would fall beyond its faces goes to the cells at them.
/// Throws std::invalid_argument for warped or nested grids, and for volumes above 4 GiB.
LightVolume inject(const VirtualLights& lights, const Domain& domain);

/// Each surfel blocks light from a direction as much as a cell's face is covered by it seen from there, in front of it alone:
/// area over that of a face, times a clamped cosine about its normal [Kaplanyan and Dachsbacher 2010, 3.2]. Shared by the corners
/// around it. Throws as `inject`.
GeometryVolume geometry_volume(const Surfels& surfels, const Domain& domain);

}  // namespace interreflect
