/// What lies at a hit: position, normals and material, ready to be shaded.
#pragma once
#include "data/scene.h"
#include "visibility/intersector.h"

namespace interreflect {

struct SurfacePoint {
    vec3 position{0};
    vec3 geometric_normal{0, 0, 1};  // unit, on the side of the viewer
    vec3 normal{0, 0, 1};            // shading normal, unit, on the side of the viewer
    vec3 albedo{0}, specular{0};     // black where a one-sided surface is seen from behind
    vec3 emission{0};                // radiance towards the viewer: that of the front face only
    vec2 texcoord{0};
    float offset = 0.0f;  // rays start at position + offset * (normal of the side they leave to)
    float alpha = 0.25f, exponent = 0.0f;
    Lobe lobe = Lobe::ggx;
    bool front = true;  // seen from the side that the winding (counter-clockwise) or the file's normals face
    std::uint32_t material = 0;
};

/// Geometry of a hit, in world space, before anything is turned towards a viewer.
struct HitGeometry {
    vec3 position, geometric_normal, normal;  // both normals unit; `normal` is the geometric one where the mesh is flat
    vec2 texcoord;
    float offset;  // self_hit_offset of the triangle
};
HitGeometry hit_geometry(const Geometry& geometry, std::uint32_t instance, std::uint32_t triangle, float u, float v);

/// The surface at a hit as seen along `direction` (unit, towards the surface). Textures are filtered by `footprint`; without one
/// they are bilinear in the finest level, as every hit but the G-buffer's is defined.
SurfacePoint surface_at(const Scene& scene, const Hit& hit, const vec3& direction, const Footprint& footprint = {});

/// The shading normal as a viewer along `to_viewer` (unit) sees it: turned to the geometric normal's side, and where it would
/// face away from the viewer bent towards the geometric normal until it does not, lest the surface be black there.
vec3 visible_normal(const vec3& normal, const vec3& geometric_normal, const vec3& to_viewer);

/// How far a ray's origin must be moved off a triangle so that it cannot meet it again: 64 units in the last place of the largest
/// coordinate that entered the arithmetic. Relative, so it works at any scale and place.
inline constexpr float self_hit_share = 0x1p-18f;
inline float self_hit_offset(const vec3& a, const vec3& b, const vec3& c) {
    const vec3 largest = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
    return self_hit_share * max_component(largest);
}
inline float self_hit_offset(const Geometry& geometry, std::uint32_t instance, std::uint32_t triangle) {
    const Corners corners = world_corners(geometry, instance, triangle);
    return self_hit_offset(corners.a, corners.b, corners.c);
}

}  // namespace interreflect
