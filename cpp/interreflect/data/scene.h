/// A scene: geometry, materials, textures and lights, as plain data.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "data/geometry.h"
#include "data/texture.h"

namespace interreflect {

/// The glossy lobe's shape. Materials have one of the first three, SCENE_FORMAT.md has the formulas; the others are techniques of
/// the stage `shade`.
enum class Lobe : std::uint8_t { ggx, phong, blinn_phong, freed_cook_torrance, gaining_blinn_phong };
inline constexpr int lobe_count = 5;
/// Lobes of microfacets of width alpha, whose reflectance rises with Schlick's term; the others have an exponent and no Fresnel
/// term.
constexpr bool has_microfacets(Lobe lobe) { return lobe == Lobe::ggx || lobe == Lobe::freed_cook_torrance; }

struct Material {
    vec3 albedo{0.5f};
    int albedo_map = -1;    // index of a texture; -1: none
    vec3 specular{0.0f};    // reflectance at normal incidence
    float alpha = 0.25f;    // GGX width: roughness squared, or sqrt(2 / (exponent + 2))
    float exponent = 0.0f;  // of the Phong and Blinn-Phong lobes
    Lobe lobe = Lobe::ggx;
    vec3 emission{0.0f};  // radiance leaving the front face
    int emission_map = -1;
    int mask = -1;          // index of a mask
    bool two_sided = true;  // for reflection; emission is one-sided

    bool emits() const { return max_component(emission) > 0.0f; }
    bool glossy() const { return max_component(specular) > 0.0f; }
};

struct PointLight {
    vec3 position{0}, intensity{1};  // W/sr
};
/// Full intensity inside `inner`, none outside `outer` (half angles, degrees), smoothstep of the cosine between them.
struct SpotLight {
    vec3 position{0}, direction{0, -1, 0}, intensity{1};
    float inner = 20, outer = 25;
};
/// `direction` of travel; irradiance on a surface facing the light.
struct DirectionalLight {
    vec3 direction{0, -1, 0}, irradiance{1};
};
/// Constant, or a latitude-longitude image (top row first) that `radiance` scales. At the identity rotation the image centre lies
/// at -z, up is +y, and u grows to the right seen from inside.
struct Environment {
    vec3 radiance{0};
    int width = 0, height = 0;  // 0: constant
    std::vector<vec3> image;
    mat3 world_from_light{1.0f};
};

/// A triangle that emits, as placed by one instance.
struct Emitter {
    std::uint32_t instance = 0, triangle = 0;
    float area = 0;    // world space
    vec3 radiance{0};  // mean over the triangle, emission map included
};

struct Scene {
    std::shared_ptr<const Geometry> geometry;
    std::vector<Material> materials;
    std::vector<std::shared_ptr<const Texture>> textures;
    std::vector<std::shared_ptr<const Mask>> masks;
    std::vector<PointLight> point_lights;
    std::vector<SpotLight> spot_lights;
    std::vector<DirectionalLight> directional_lights;
    std::optional<Environment> environment;
    std::vector<Emitter> emitters;  // derived by finish_scene

    std::uint32_t material_of(std::uint32_t triangle) const { return geometry->arrays->materials[triangle]; }
};

/// Checks every handle and number (std::invalid_argument names what is wrong) and lists the emitters.
void finish_scene(Scene& scene);

}  // namespace interreflect
