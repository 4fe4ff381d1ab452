/// Room direct: light that the pixels reflect once.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>

#include "bindings/arrays.h"
#include "bindings/pyramids.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "bindings/technique.h"
#include "direct/reflective_shadow_map.h"
#include "direct/shadow.h"
#include "direct/sky.h"

namespace interreflect::bindings {
namespace {

using SharedLight = std::shared_ptr<DirectLight>;

template <class Technique>
void bind_shadow(py::module_& m) {
    m.def(
        "shadow",
        [](const Technique& technique, const BoundScene& s, const GBuffer& g, std::uint32_t seed) -> SharedLight {
            return run(
                [&] { return std::make_shared<DirectLight>(shadow(technique, s.scene, *s.intersector, *s.lights, g, seed)); });
        },
        py::arg("technique"), py::arg("scene"), py::arg("gbuffer"), py::arg("seed") = 0);
}

SharedLight cone_shadow(const VoxelCones& technique, const BoundScene& s, const GBuffer& g,
                        const std::vector<std::shared_ptr<const Pyramid>>& pyramids, std::uint32_t seed) {
    const auto each = plain_pointers(pyramids);
    return run(
        [&] { return std::make_shared<DirectLight>(shadow(technique, s.scene, *s.intersector, *s.lights, g, each, seed)); });
}

/// The pixels of an (h, w, 3) image, borrowed from numpy; ValueError unless it has the G-buffer's size.
std::span<const vec3> image_pixels(const py::object& image, const GBuffer& g, const char* name) {
    const auto array = exact_array<float>(image, name);
    if (array.ndim() != 3 || array.shape(0) != g.height || array.shape(1) != g.width || array.shape(2) != 3)
        throw py::value_error(std::string(name) + " must have the G-buffer's shape (" + std::to_string(g.height) + ", " +
                              std::to_string(g.width) + ", 3)");
    return {reinterpret_cast<const vec3*>(array.data()), g.pixels()};
}

SharedLight cone_sky(const GBuffer& g, const py::object& gathered, const py::object& glossy) {
    const py::object irradiance = gathered.attr("sky");
    const py::object lobe = glossy.is_none() ? py::object(py::none()) : py::object(glossy.attr("sky"));
    const auto arrived = image_pixels(irradiance, g, "gathered.sky");
    const auto reflected = lobe.is_none() ? std::span<const vec3>() : image_pixels(lobe, g, "glossy.sky");
    return run([&] { return std::make_shared<DirectLight>(sky(ConeSky{}, g, arrived, reflected)); });
}

void bind_reflective_shadow_map(py::module_& m) {
    using Map = ReflectiveShadowMap;
    py::class_<Map, std::shared_ptr<Map>> cls(
        m, "ReflectiveShadowMap",
        "What a light sees, and the flux that every texel's surface sends on: (size, size[, 3]) views.");
    const auto image = [&cls](const char* name, auto member, const char* doc) {
        cls.def_property_readonly(
            name,
            [member](const py::object& self) {
                const auto& map = self.cast<const Map&>();
                return image_view(map.*member, map.size, map.size, self);
            },
            doc);
    };
    image("position", &Map::position, "World space; (0, 0, 0) where nothing is met.");
    image("normal", &Map::normal, "Shading normal on the light's side; (0, 0, 0) where nothing is met.");
    image("incident", &Map::incident, "Flux that arrives through the texel, W.");
    image("flux", &Map::flux, "Flux that the diffuse lobe sends on: albedo times incident, W.");
    image("specular", &Map::specular, "Reflectance of the glossy lobe at normal incidence.");
    image("alpha", &Map::alpha, "GGX width of the glossy lobe.");
    image("area", &Map::area, "Of surface that the texel covers, scene units squared.");
    cls.def_readonly("counts", &Map::counts).def_property_readonly("bytes", &Map::bytes);
    m.def(
        "reflective_shadow_map",
        [](const BoundScene& s, int light, int size) {
            return run(
                [&] { return std::make_shared<Map>(reflective_shadow_map(s.scene, *s.intersector, *s.lights, light, size)); });
        },
        py::arg("scene"), py::arg("light"), py::arg("size"),
        "What a spot or directional light sees; `light` counts point, then spot, then directional lights.");
    py::class_<LightMaps, std::shared_ptr<LightMaps>>(m, "LightMaps", "What all lights of a scene see.")
        .def_property_readonly(
            "maps",
            [](const std::shared_ptr<LightMaps>& self) {
                py::list maps;
                for (auto& map : self->maps) maps.append(std::shared_ptr<Map>(self, &map));
                return py::tuple(maps);
            },
            "A ReflectiveShadowMap each.")
        .def_readonly("counts", &LightMaps::counts)
        .def_property_readonly("bytes", &LightMaps::bytes);
    m.def(
        "light_maps",
        [](const BoundScene& s, int size, int emitter_views, const std::vector<DirectionalLight>& environment) {
            const LightMapKnobs knobs{size, emitter_views, environment};
            return run([&] { return std::make_shared<LightMaps>(light_maps(s.scene, *s.intersector, *s.lights, knobs)); });
        },
        py::arg("scene"), py::arg("size"), py::arg("emitter_views"), py::arg("environment"),
        "What all lights of a scene see; `environment`: directional lights that stand for the environment.");
}

}  // namespace

void bind_direct(py::module_& m) {
    py::class_<DirectLight, SharedLight>(m, "DirectLight",
                                         "Light that the pixels of a G-buffer reflect once, towards the camera.")
        .def_property_readonly(
            "radiance",
            [](const py::object& self) {
                const auto& light = self.cast<const DirectLight&>();
                return image_view(light.radiance, light.width, light.height, self);
            },
            "(height, width, 3) view, W/(m^2 sr).")
        .def_readonly("counts", &DirectLight::counts)
        .def_property_readonly("bytes", [](const DirectLight& light) { return light.radiance.bytes(); });
    bind_stage(m, "shadow", "What pixels reflect of point, spot and directional lights and of emitters.", true,
               static_cast<const Shadow*>(nullptr));
    bind_stage(m, "sky", "What pixels reflect of the environment.", true, static_cast<const Sky*>(nullptr));
    bind_shadow<TracedShadows>(m);
    bind_shadow<ShadowMap>(m);
    py::class_<ShadowMaps, std::shared_ptr<ShadowMaps>>(m, "ShadowMaps",
                                                        "Depth seen from all point, spot and directional lights.")
        .def_property_readonly(
            "depth",
            [](const py::object& self) {
                py::list found;
                for (const DepthMaps& light : self.cast<const ShadowMaps&>().lights)
                    for (const DepthMap& map : light.maps)
                        found.append(image_view(map.depth, map.view.size, map.view.size, self));
                return py::tuple(found);
            },
            "(size, size) of each map, six for a point light: distance along the texel's ray, infinite where nothing is met.")
        .def_readonly("counts", &ShadowMaps::counts)
        .def_property_readonly("bytes", &ShadowMaps::bytes);
    m.def(
        "shadow_maps",
        [](const ShadowMap& technique, const BoundScene& s) {
            return run([&] { return std::make_shared<ShadowMaps>(shadow_maps(technique, s.scene, *s.intersector)); });
        },
        py::arg("technique"), py::arg("scene"), "Depth seen from every light, to be shared by all that it lights.");
    m.def(
        "shadow",
        [](const ShadowMap& technique, const BoundScene& s, const GBuffer& g, const ShadowMaps& maps,
           std::uint32_t seed) -> SharedLight {
            return run([&] {
                return std::make_shared<DirectLight>(shadow(technique, maps, s.scene, *s.intersector, *s.lights, g, seed));
            });
        },
        py::arg("technique"), py::arg("scene"), py::arg("gbuffer"), py::arg("maps"), py::arg("seed") = 0,
        "By maps that are there.");
    m.def("cone_shadow", &cone_shadow, py::arg("technique"), py::arg("scene"), py::arg("gbuffer"), py::arg("pyramids"),
          py::arg("seed") = 0, "VoxelCones through the pyramids of one scene's voxels, one or more.");
    m.def(
        "sky",
        [](const TracedSky& technique, const BoundScene& s, const GBuffer& g, std::uint32_t seed) -> SharedLight {
            return run(
                [&] { return std::make_shared<DirectLight>(sky(technique, s.scene, *s.intersector, *s.lights, g, seed)); });
        },
        py::arg("technique"), py::arg("scene"), py::arg("gbuffer"), py::arg("seed") = 0);
    bind_reflective_shadow_map(m);
    m.def("cone_sky", &cone_sky, py::arg("gbuffer"), py::arg("gathered"), py::arg("glossy") = py::none(),
          "What the march's cones left open: albedo / pi * gathered.sky + glossy.sky.");
}

}  // namespace interreflect::bindings
