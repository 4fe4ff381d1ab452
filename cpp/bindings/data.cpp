/// Room data: textures, materials, lights, cameras, geometry and scenes.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "data/camera.h"
#include "data/counts.h"

namespace interreflect::bindings {
namespace {

using Float3 = std::array<float, 3>;

std::shared_ptr<Texture> make_texture(const py::array& pixels) {
    if (pixels.ndim() != 3) throw py::value_error("pixels must have shape (height, width, channels)");
    const int height = static_cast<int>(pixels.shape(0)), width = static_cast<int>(pixels.shape(1)),
              channels = static_cast<int>(pixels.shape(2));
    if (py::isinstance<py::array_t<std::uint8_t>>(pixels)) {
        const auto bytes = exact_array<std::uint8_t>(pixels, "pixels");
        return run([&] {
            return std::make_shared<Texture>(
                Texture::from_srgb8({bytes.data(), static_cast<std::size_t>(bytes.size())}, width, height, channels));
        });
    }
    const auto floats = exact_array<float>(pixels, "pixels");
    if (channels != 3) throw py::value_error("float pixels must have 3 channels");
    const std::span<const float> values(floats.data(), static_cast<std::size_t>(floats.size()));
    for (const float v : values)
        if (!std::isfinite(v) || v < 0.0f) throw py::value_error("pixels must be finite and not negative");
    return run([&] { return std::make_shared<Texture>(Texture::from_linear(values, width, height)); });
}

std::shared_ptr<Mask> make_mask(const py::object& pixels) {
    const auto array = exact_array<bool>(pixels, "pixels");
    if (array.ndim() != 2) throw py::value_error("pixels must have shape (height, width)");
    const std::span<const std::uint8_t> solid(reinterpret_cast<const std::uint8_t*>(array.data()),
                                              static_cast<std::size_t>(array.size()));
    return std::make_shared<Mask>(solid, static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)));
}

Material make_material(Float3 albedo, int albedo_map, Float3 specular, float roughness, float exponent, const std::string& lobe,
                       Float3 emission, int emission_map, int mask, bool two_sided) {
    static const std::map<std::string, Lobe> lobes{
        {"ggx", Lobe::ggx}, {"phong", Lobe::phong}, {"blinn-phong", Lobe::blinn_phong}};
    if (!lobes.contains(lobe)) throw py::value_error("lobe must be one of ggx, phong, blinn-phong, got '" + lobe + "'");
    if (!(roughness >= 0.0f && roughness <= 1.0f)) throw py::value_error("roughness must lie in [0, 1]");
    // Roughness 0 means the smallest width that single precision evaluates well.
    constexpr float least_alpha = 1e-3f;
    Material m;
    m.albedo = vector3(albedo), m.albedo_map = albedo_map, m.specular = vector3(specular);
    m.alpha = std::fmax(exponent > 0.0f ? std::sqrt(2.0f / (exponent + 2.0f)) : roughness * roughness, least_alpha);
    m.exponent = exponent, m.lobe = lobes.at(lobe), m.emission = vector3(emission), m.emission_map = emission_map;
    m.mask = mask, m.two_sided = two_sided;
    return m;
}

Camera make_camera(Float3 position, Float3 target, Float3 up, float fov_x) {
    const Camera camera{vector3(position), vector3(target), vector3(up), fov_x};
    if (!(fov_x > 0.0f && fov_x < 180.0f))
        throw py::value_error("fov_x must lie in (0, 180) degrees, got " + std::to_string(fov_x));
    const CameraRays rays(camera, 1, 1);
    if (!std::isfinite(glm::dot(rays.corner, rays.right_step)) || !std::isfinite(glm::length(camera.position)))
        throw py::value_error("position, target and up must be finite, position not target, and up not parallel to the view");
    return camera;
}

std::vector<Placement> read_placements(const py::list& instances) {
    std::vector<Placement> placements;
    for (const auto& item : instances) {
        const auto one = item.cast<std::tuple<std::uint32_t, py::object, std::uint32_t>>();
        placements.push_back({std::get<0>(one), matrix4(std::get<1>(one), "instances: transform"), std::get<2>(one)});
    }
    return placements;
}

std::shared_ptr<const Geometry> read_geometry(const py::list& meshes, const py::list& instances) {
    std::vector<MeshView> views;
    for (const auto& item : meshes) {
        const auto m = item.cast<std::tuple<py::object, py::object, py::object, py::object, std::uint32_t>>();
        MeshView view{rows<vec3, float>(std::get<0>(m), "positions"),
                      rows<uvec3, std::uint32_t>(std::get<1>(m), "triangles"),
                      {},
                      {},
                      std::get<4>(m)};
        if (!std::get<2>(m).is_none()) view.normals = rows<vec3, float>(std::get<2>(m), "normals");
        if (!std::get<3>(m).is_none()) view.texcoords = rows<vec2, float>(std::get<3>(m), "texcoords");
        views.push_back(view);
    }
    return make_geometry(views, read_placements(instances));
}

Environment make_environment(Float3 radiance, const py::object& image, const py::object& rotation) {
    Environment e;
    e.radiance = vector3(radiance);
    if (!image.is_none()) {
        const auto array = exact_array<float>(image, "image");
        if (array.ndim() != 3 || array.shape(2) != 3 || array.size() == 0)
            throw py::value_error("image must have shape (height, width, 3) with at least one pixel");
        e.height = static_cast<int>(array.shape(0)), e.width = static_cast<int>(array.shape(1));
        const auto* texels = reinterpret_cast<const vec3*>(array.data());
        e.image.assign(texels, texels + static_cast<std::size_t>(e.width) * e.height);
    }
    if (!rotation.is_none()) {
        const auto array = exact_array<double>(rotation, "rotation");
        if (array.ndim() != 2 || array.shape(0) != 3 || array.shape(1) != 3)
            throw py::value_error("rotation must have shape (3, 3)");
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                e.world_from_light[column][row] = static_cast<float>(array.at(row, column));
        const mat3 product = e.world_from_light * glm::transpose(e.world_from_light);
        for (int k = 0; k < 9; ++k)
            if (!(std::fabs(product[k / 3][k % 3] - (k % 4 == 0 ? 1.0f : 0.0f)) < 1e-4f))
                throw py::value_error("rotation must be a rotation matrix");
    }
    return e;
}

std::shared_ptr<BoundScene> make_scene(std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Intersector> intersector,
                                       std::vector<Material> materials, std::vector<std::shared_ptr<Texture>> textures,
                                       std::vector<std::shared_ptr<Mask>> masks, const py::list& lights,
                                       std::optional<Environment> environment) {
    auto bound = std::make_shared<BoundScene>();
    Scene& scene = bound->scene;
    scene.geometry = std::move(geometry);
    scene.materials = std::move(materials);
    scene.textures.assign(textures.begin(), textures.end());
    scene.masks.assign(masks.begin(), masks.end());
    for (const auto& light : lights) {
        if (py::isinstance<PointLight>(light))
            scene.point_lights.push_back(light.cast<PointLight>());
        else if (py::isinstance<SpotLight>(light))
            scene.spot_lights.push_back(light.cast<SpotLight>());
        else if (py::isinstance<DirectionalLight>(light))
            scene.directional_lights.push_back(light.cast<DirectionalLight>());
        else
            throw py::type_error("lights must hold PointLight, SpotLight and DirectionalLight, got " +
                                 py::repr(light).cast<std::string>());
    }
    scene.environment = std::move(environment);
    if (intersector == nullptr || intersector->geometry() != scene.geometry)
        throw py::value_error("intersector was built from another geometry");
    bound->intersector = std::move(intersector);
    run([&] {
        finish_scene(scene);
        bound->lights = std::make_shared<LightSampler>(scene);
    });
    return bound;
}

void bind_lights(py::module_& m) {
    py::class_<PointLight>(m, "PointLight")
        .def(py::init([](Float3 position, Float3 intensity) {
                 return PointLight{vector3(position), vector3(intensity)};
             }),
             py::arg("position"), py::arg("intensity"));
    py::class_<SpotLight>(m, "SpotLight")
        .def(py::init([](Float3 position, Float3 direction, Float3 intensity, float inner, float outer) {
                 return SpotLight{vector3(position), vector3(direction), vector3(intensity), inner, outer};
             }),
             py::arg("position"), py::arg("direction"), py::arg("intensity"), py::arg("inner"), py::arg("outer"));
    py::class_<DirectionalLight>(m, "DirectionalLight")
        .def(py::init([](Float3 direction, Float3 irradiance) {
                 return DirectionalLight{vector3(direction), vector3(irradiance)};
             }),
             py::arg("direction"), py::arg("irradiance"));
    py::class_<Environment>(m, "Environment")
        .def(py::init(&make_environment), py::arg("radiance"), py::arg("image") = py::none(), py::arg("rotation") = py::none());
}

void bind_counts(py::module_& m) {
    py::class_<Counts>(m, "Counts", "Work counts of one stage.")
        .def(
            "asdict",
            [](const Counts& c) {
                py::dict d;
                for (const NamedCount& count : every_count)
                    if (c.*count.member != 0) d[py::str(std::string(count.name))] = c.*count.member;
                return d;
            },
            "The counts that are not zero.");
}

}  // namespace

void bind_data(py::module_& m) {
    bind_counts(m);
    bind_lights(m);
    py::class_<Texture, std::shared_ptr<Texture>>(m, "Texture")
        .def(py::init(&make_texture), py::arg("pixels"))
        .def_property_readonly("bytes", &Texture::bytes);
    py::class_<Mask, std::shared_ptr<Mask>>(m, "Mask").def(py::init(&make_mask), py::arg("pixels"));
    py::class_<Material>(m, "Material")
        .def(py::init(&make_material), py::kw_only(), py::arg("albedo") = Float3{.5f, .5f, .5f}, py::arg("albedo_map") = -1,
             py::arg("specular") = Float3{0, 0, 0}, py::arg("roughness") = .5f, py::arg("exponent") = 0.0f,
             py::arg("lobe") = "ggx", py::arg("emission") = Float3{0, 0, 0}, py::arg("emission_map") = -1, py::arg("mask") = -1,
             py::arg("two_sided") = true);
    py::class_<Camera>(m, "Camera")
        .def(py::init(&make_camera), py::arg("position"), py::arg("target"), py::arg("up"), py::arg("fov_x"));
    py::class_<Geometry, std::shared_ptr<Geometry>>(m, "Geometry")
        .def(py::init([](const py::list& meshes, const py::list& instances) {
                 return std::const_pointer_cast<Geometry>(read_geometry(meshes, instances));
             }),
             py::arg("meshes"), py::arg("instances"))
        .def(
            "moved",
            [](const Geometry& self, const py::list& instances) {
                return std::const_pointer_cast<Geometry>(move_geometry(self, read_placements(instances)));
            },
            py::arg("instances"), "The same geometry with every moving instance at its new transform.")
        .def_property_readonly(
            "instances", [](const Geometry& self) { return self.instances.size() - 1; }, "How many instances are not baked.")
        .def_property_readonly("triangles", &Geometry::triangle_count)
        .def_property_readonly("bounds", [](const Geometry& self) {
            const auto b = self.bounds();
            return std::array<Float3, 2>{array3(b.lower), array3(b.upper)};
        });
}

void bind_scene(py::module_& m) {
    py::class_<BoundScene, std::shared_ptr<BoundScene>>(m, "Scene")
        .def(py::init([](std::shared_ptr<Geometry> geometry, std::shared_ptr<Intersector> intersector,
                         std::vector<Material> materials, std::vector<std::shared_ptr<Texture>> textures,
                         std::vector<std::shared_ptr<Mask>> masks, const py::list& lights,
                         std::optional<Environment> environment) {
                 return make_scene(std::move(geometry), std::move(intersector), std::move(materials), std::move(textures),
                                   std::move(masks), lights, std::move(environment));
             }),
             py::arg("geometry"), py::arg("intersector"), py::arg("materials"), py::arg("textures"), py::arg("masks"),
             py::arg("lights"), py::arg("environment") = py::none());
}

}  // namespace interreflect::bindings
