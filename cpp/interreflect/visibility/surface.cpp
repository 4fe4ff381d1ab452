#include "visibility/surface.h"

namespace interreflect {

HitGeometry hit_geometry(const Geometry& geometry, std::uint32_t instance, std::uint32_t triangle, float u, float v) {
    const auto& arrays = *geometry.arrays;
    const uvec3 t = arrays.triangles[triangle];
    const float w = 1.0f - u - v;
    HitGeometry at;
    const Vertex &va = arrays.vertices[t.x], &vb = arrays.vertices[t.y], &vc = arrays.vertices[t.z];
    const vec3 a = va.position, b = vb.position, c = vc.position;
    at.position = a * w + b * u + c * v;
    vec3 geometric = glm::cross(b - a, c - a);
    vec3 shading = va.normal * w + vb.normal * u + vc.normal * v;
    at.texcoord = va.texcoord * w + vb.texcoord * u + vc.texcoord * v;
    const Instance& placed = geometry.instances[instance];
    at.offset = placed.identity ? self_hit_offset(a, b, c) : self_hit_offset(geometry, instance, triangle);
    if (!placed.identity) {
        at.position = placed.world_from_local * vec4(at.position, 1);
        geometric = placed.normal_from_local * geometric;
        shading = placed.normal_from_local * shading;
    }
    at.geometric_normal = glm::normalize(geometric);
    const float length = glm::length(shading);
    at.normal = length > 0.0f ? shading / length : at.geometric_normal;
    return at;
}

vec3 visible_normal(const vec3& normal, const vec3& geometric_normal, const vec3& to_viewer) {
    const vec3 same_side = glm::dot(normal, geometric_normal) < 0.0f ? -normal : normal;
    const float cosine = glm::dot(same_side, to_viewer);
    if (cosine > 0.0f) return same_side;
    // The weights leave the bent normal a cosine above 0: a 64th of the square of the geometric one, before it is made unit.
    const float geometric = std::fmax(glm::dot(geometric_normal, to_viewer), 1e-6f);
    return glm::normalize(same_side * geometric + geometric_normal * (0x1p-6f * geometric - cosine));
}

SurfacePoint surface_at(const Scene& scene, const Hit& hit, const vec3& direction, const Footprint& footprint) {
    const HitGeometry at = hit_geometry(*scene.geometry, hit.instance, hit.triangle, hit.u, hit.v);
    SurfacePoint point;
    point.position = at.position;
    point.texcoord = at.texcoord;
    point.offset = at.offset;
    point.material = scene.material_of(hit.triangle);
    const Material& material = scene.materials[point.material];
    point.front = glm::dot(at.geometric_normal, direction) < 0.0f;
    point.geometric_normal = point.front ? at.geometric_normal : -at.geometric_normal;
    point.normal = visible_normal(at.normal, point.geometric_normal, -direction);
    point.alpha = material.alpha;
    point.exponent = material.exponent;
    point.lobe = material.lobe;
    if (point.front || material.two_sided) {
        point.albedo = material.albedo;
        if (material.albedo_map >= 0) point.albedo *= scene.textures[material.albedo_map]->filtered(point.texcoord, footprint);
        point.specular = material.specular;
    }
    if (point.front && material.emits()) {
        point.emission = material.emission;
        if (material.emission_map >= 0)
            point.emission *= scene.textures[material.emission_map]->filtered(point.texcoord, footprint);
    }
    return point;
}

}  // namespace interreflect
