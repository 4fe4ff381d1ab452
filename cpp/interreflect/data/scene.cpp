#include "data/scene.h"

#include <stdexcept>
#include <string>

namespace interreflect {
namespace {

bool finite(const vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool positive(const vec3& v) { return finite(v) && min_component(v) >= 0.0f; }

void require(bool holds, const std::string& what) {
    if (!holds) throw std::invalid_argument(what);
}

void check_material(const Material& m, std::size_t i, const Scene& scene) {
    const std::string name = "materials[" + std::to_string(i) + "]";
    const auto textures = static_cast<int>(scene.textures.size()), masks = static_cast<int>(scene.masks.size());
    require(positive(m.albedo), name + ".albedo must be finite and not negative");
    require(positive(m.specular), name + ".specular must be finite and not negative");
    require(positive(m.emission), name + ".emission must be finite and not negative");
    require(std::isfinite(m.alpha) && m.alpha > 0.0f, name + ": roughness must be finite and above 0");
    require(std::isfinite(m.exponent) && m.exponent >= 0.0f, name + ".exponent must be finite and not negative");
    require(m.albedo_map >= -1 && m.albedo_map < textures, name + ".albedo_map names no texture");
    require(m.emission_map >= -1 && m.emission_map < textures, name + ".emission_map names no texture");
    require(m.mask >= -1 && m.mask < masks, name + ".mask names no mask");
}

void check_lights(const Scene& scene) {
    for (std::size_t i = 0; i < scene.point_lights.size(); ++i) {
        const auto& light = scene.point_lights[i];
        require(finite(light.position) && positive(light.intensity),
                "point light " + std::to_string(i) + " must be finite and not negative");
    }
    for (std::size_t i = 0; i < scene.spot_lights.size(); ++i) {
        const auto& light = scene.spot_lights[i];
        const std::string name = "spot light " + std::to_string(i);
        require(finite(light.position) && positive(light.intensity), name + " must be finite and not negative");
        require(finite(light.direction) && glm::length(light.direction) > 0.0f, name + ".direction must not be zero");
        require(light.inner >= 0.0f && light.inner <= light.outer && light.outer <= 180.0f,
                name + ": 0 <= inner <= outer <= 180 degrees");
    }
    for (std::size_t i = 0; i < scene.directional_lights.size(); ++i) {
        const auto& light = scene.directional_lights[i];
        const std::string name = "directional light " + std::to_string(i);
        require(positive(light.irradiance), name + ".irradiance must be finite and not negative");
        require(finite(light.direction) && glm::length(light.direction) > 0.0f, name + ".direction must not be zero");
    }
    if (!scene.environment) return;
    const Environment& e = *scene.environment;
    require(positive(e.radiance), "environment.radiance must be finite and not negative");
    require(e.image.size() == static_cast<std::size_t>(e.width) * e.height, "environment.image does not fill width x height");
    for (const auto& texel : e.image) require(positive(texel), "environment.image must be finite and not negative");
}

/// The emission map's mean over a triangle: a fixed pattern of 64 points.
vec3 mean_emission(const Texture& map, const GeometryArrays& arrays, const uvec3& t) {
    constexpr int n = 8;
    vec3 sum{0};
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            float u = (static_cast<float>(i) + 0.5f) / n, v = (static_cast<float>(j) + 0.5f) / n;
            if (u + v > 1.0f) u = 1.0f - u, v = 1.0f - v;
            sum += map.bilinear(arrays.texcoords[t.x] * (1.0f - u - v) + arrays.texcoords[t.y] * u + arrays.texcoords[t.z] * v);
        }
    return sum / static_cast<float>(n * n);
}

void list_emitters(Scene& scene) {
    scene.emitters.clear();
    const Geometry& geometry = *scene.geometry;
    for (std::uint32_t i = 0; i < geometry.instances.size(); ++i) {
        const Group& group = geometry.groups[geometry.instances[i].group];
        for (std::uint32_t k = 0; k < group.triangle_count; ++k) {
            const std::uint32_t triangle = group.first_triangle + k;
            const Material& material = scene.materials[scene.material_of(triangle)];
            if (!material.emits()) continue;
            const Corners c = world_corners(geometry, i, triangle);
            const float area = 0.5f * glm::length(glm::cross(c.b - c.a, c.c - c.a));
            if (!(area > 0.0f)) continue;
            vec3 radiance = material.emission;
            if (material.emission_map >= 0)
                radiance *=
                    mean_emission(*scene.textures[material.emission_map], *geometry.arrays, geometry.arrays->triangles[triangle]);
            scene.emitters.push_back({i, triangle, area, radiance});
        }
    }
}

}  // namespace

void finish_scene(Scene& scene) {
    require(scene.geometry != nullptr, "scene.geometry is missing");
    for (const auto material : scene.geometry->arrays->materials)
        require(material < scene.materials.size(),
                "a mesh names material " + std::to_string(material) + " of " + std::to_string(scene.materials.size()));
    for (std::size_t i = 0; i < scene.materials.size(); ++i) check_material(scene.materials[i], i, scene);
    check_lights(scene);
    for (auto& light : scene.spot_lights) light.direction = glm::normalize(light.direction);
    for (auto& light : scene.directional_lights) light.direction = glm::normalize(light.direction);
    list_emitters(scene);
}

}  // namespace interreflect
