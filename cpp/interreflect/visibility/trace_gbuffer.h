/// The G-buffer by primary rays through pixel centres.
#pragma once
#include "data/gbuffer.h"
#include "data/scene.h"
#include "visibility/intersector.h"
#include "visibility/surface.h"

namespace interreflect {

/// What the camera sees at every pixel's centre; textures are filtered by the pixel's footprint on the surface.
/// Throws std::invalid_argument where the camera or the size makes no picture.
GBuffer trace_gbuffer(const Scene& scene, const Intersector& intersector, const Camera& camera, int width, int height);

/// Throws std::invalid_argument where the camera or the size makes no picture.
void check_view(const Camera& camera, int width, int height);

/// How far texture coordinates move from one pixel to the next at a hit of the primary ray through (x, y) (pixel centres at
/// + 0.5). Pass it to surface_at for the same surface as the G-buffer's.
Footprint pixel_footprint(const Scene& scene, const Hit& hit, const CameraRays& rays, float x, float y);

}  // namespace interreflect
