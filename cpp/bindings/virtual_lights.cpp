/// Room virtual_lights: sample, cluster, shadow, filter, shade.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "bindings/technique.h"
#include "direct/reflective_shadow_map.h"
#include "virtual_lights/cluster.h"
#include "virtual_lights/further_bounces.h"
#include "virtual_lights/light_pixels.h"
#include "virtual_lights/sample.h"
#include "virtual_lights/shadow.h"

namespace interreflect::bindings {
namespace {

/// Lights that a user placed.
std::shared_ptr<VirtualLights> placed_lights(const py::object& position, const py::object& normal, const py::object& flux,
                                             const py::object& area, const py::object& offset) {
    const auto at = rows<vec3, float>(position, "position");
    const auto facing = rows<vec3, float>(normal, "normal"), sent = rows<vec3, float>(flux, "flux");
    const auto areas = exact_array<float>(area, "area"), offsets = exact_array<float>(offset, "offset");
    const std::size_t n = at.size();
    const auto as_many = [n](std::size_t count, const char* name) {
        if (count != n) throw py::value_error(std::string(name) + " must have as many entries as position, " + std::to_string(n));
    };
    as_many(facing.size(), "normal"), as_many(sent.size(), "flux");
    as_many(static_cast<std::size_t>(areas.size()), "area"), as_many(static_cast<std::size_t>(offsets.size()), "offset");
    auto lights = std::make_shared<VirtualLights>(make_virtual_lights(n));
    for (std::size_t i = 0; i < n; ++i) {
        lights->position[i] = at[i], lights->normal[i] = facing[i], lights->flux[i] = sent[i];
        lights->area[i] = areas.data()[i], lights->offset[i] = offsets.data()[i];
        lights->texel[i] = no_virtual_light, lights->members[i] = 0;
        const auto light = [i](const char* what) { return "light " + std::to_string(i) + ": " + what; };
        if (!std::isfinite(glm::dot(at[i], vec3(1)))) throw py::value_error(light("position must be finite"));
        if (!(std::fabs(glm::length(facing[i]) - 1.0f) < 1e-3f)) throw py::value_error(light("normal must have length 1"));
        if (!(min_component(sent[i]) >= 0.0f) || !std::isfinite(max_component(sent[i])))
            throw py::value_error(light("flux must be finite and not negative"));
        if (!(lights->area[i] >= 0.0f) || !std::isfinite(lights->area[i]))
            throw py::value_error(light("area must be finite and not negative"));
        if (!(lights->offset[i] >= 0.0f) || !std::isfinite(lights->offset[i]))
            throw py::value_error(light("offset must be finite and not negative"));
    }
    return lights;
}

void bind_lights(py::module_& m) {
    using Lights = VirtualLights;
    py::class_<Lights, std::shared_ptr<Lights>> cls(m, "VirtualLights",
                                                    "Disks of lit surface that reflect diffusely; n lights in parallel arrays.");
    cls.def(py::init(&placed_lights), py::arg("position"), py::arg("normal"), py::arg("flux"), py::arg("area"), py::arg("offset"),
            "Lights of one's own: float32 arrays (n, 3), (n, 3) unit, (n, 3) W, (n,) scene units squared, and how far off the "
            "surface rays start, (n,) scene units. ValueError names the array or the light that is wrong.");
    const auto three = [&cls](const char* name, Buffer<vec3> Lights::*member, const char* doc) {
        cls.def_property_readonly(
            name, [member](const py::object& self) { return vectors(self.cast<const Lights&>().*member, self); }, doc);
    };
    three("position", &Lights::position, "(n, 3): world space.");
    three("normal", &Lights::normal, "(n, 3): unit.");
    three("flux", &Lights::flux, "(n, 3): sent on, W.");
    cls.def_property_readonly(
        "area", [](const py::object& self) { return numbers(self.cast<const Lights&>().area, self); },
        "(n,): scene units squared.");
    cls.def_property_readonly(
        "offset", [](const py::object& self) { return numbers(self.cast<const Lights&>().offset, self); },
        "(n,): how far off the surface rays start, scene units.");
    cls.def_property_readonly(
        "texel", [](const py::object& self) { return numbers(self.cast<const Lights&>().texel, self); },
        "(n,): where each stands, a number over the texels of all maps.");
    cls.def_property_readonly(
        "members", [](const py::object& self) { return numbers(self.cast<const Lights&>().members, self); },
        "(n,): texels that each stands for.");
    cls.def_property_readonly(
        "cluster",
        [](const py::object& self) {
            const auto& lights = self.cast<const Lights&>();
            py::list maps;
            std::size_t first = 0;
            for (const int size : lights.map_sizes) {
                if (lights.cluster.empty()) break;
                maps.append(view(lights.cluster.data() + first, {size, size}, self));
                first += static_cast<std::size_t>(size) * size;
            }
            return py::tuple(maps);
        },
        "(size, size) of each map: every texel's light, 2^32 - 1 where it sends nothing on. Empty but for KMeans.");
    cls.def("__len__", &Lights::size).def_readonly("counts", &Lights::counts).def_property_readonly("bytes", &Lights::bytes);
}

void bind_shadows(py::module_& m) {
    py::class_<SurfacePoints, std::shared_ptr<SurfacePoints>>(m, "SurfacePoints",
                                                              "Points that stand for a scene's surface in shadow maps.")
        .def("__len__", &SurfacePoints::size)
        .def_property_readonly(
            "position", [](const py::object& self) { return vectors(self.cast<const SurfacePoints&>().position, self); },
            "(n, 3): in the space of the instance that each moves with.")
        .def_readonly("area", &SurfacePoints::area, "Of the whole surface, scene units squared.")
        .def_property_readonly("bytes", &SurfacePoints::bytes);
    py::class_<LightShadows, std::shared_ptr<LightShadows>>(m, "LightShadows", "What virtual lights see of a scene.")
        .def_property_readonly(
            "depth",
            [](const py::object& self) {
                const auto& shadows = self.cast<const LightShadows&>();
                const auto size = static_cast<py::ssize_t>(shadows.size);
                const auto n = size > 0 ? static_cast<py::ssize_t>(shadows.depth.size()) / (size * size) : py::ssize_t{0};
                return view(shadows.depth.data(), {n, size, size}, self);
            },
            "(n, size, size): radial distance in each light's paraboloid map, infinite where it is open; none without maps.")
        .def_readonly("counts", &LightShadows::counts)
        .def_property_readonly("bytes", &LightShadows::bytes);
}

void bind_light(py::module_& m) {
    py::class_<VirtualLight, std::shared_ptr<VirtualLight>>(m, "VirtualLight", "What pixels get from virtual lights.")
        .def_property_readonly(
            "gathered",
            [](const std::shared_ptr<VirtualLight>& self) { return std::shared_ptr<GatheredLight>(self, &self->gathered); },
            "What arrives over the hemisphere: irradiance alone.")
        .def_property_readonly(
            "glossy", [](const std::shared_ptr<VirtualLight>& self) { return std::shared_ptr<GlossyLight>(self, &self->glossy); },
            "What the glossy lobe reflects: radiance alone.")
        .def_readonly("counts", &VirtualLight::counts)
        .def_property_readonly("bytes", &VirtualLight::bytes);
}

void bind_stages(py::module_& m) {
    bind_stage(m, "sample_lights", "Which texels of reflective shadow maps become virtual lights, or seeds of clusters.", true,
               static_cast<const SampleLights*>(nullptr));
    bind_stage(m, "cluster_lights", "Which texels one virtual light stands for.", true,
               static_cast<const ClusterLights*>(nullptr));
    bind_stage(m, "shadow_lights", "What virtual lights see.", true, static_cast<const ShadowLights*>(nullptr));
    bind_stage(m, "filter_shadows", "How much of a virtual light a pixel sees.", true,
               static_cast<const FilterShadows*>(nullptr));
    bind_stage(m, "shade_lights", "How much of a virtual light's flux arrives at a pixel.", true,
               static_cast<const ShadeLights*>(nullptr));
}

void bind_functions(py::module_& m) {
    m.def(
        "sample_lights",
        [](const SampleLights& technique, const LightMaps& maps, std::uint32_t seed) {
            return run([&] {
                return std::make_shared<VirtualLights>(
                    std::visit([&](const auto& one) { return sample_lights(one, maps, seed); }, technique));
            });
        },
        py::arg("technique"), py::arg("maps"), py::arg("seed") = 0, "Texels that become virtual lights, or seeds of clusters.");
    m.def(
        "cluster_lights",
        [](const ClusterLights& technique, const VirtualLights& seeds, const LightMaps& maps, const VirtualLights* last,
           std::uint32_t seed) {
            return run([&] {
                return std::make_shared<VirtualLights>(
                    std::visit([&](const auto& one) { return cluster_lights(one, seeds, maps, last, seed); }, technique));
            });
        },
        py::arg("technique"), py::arg("seeds"), py::arg("maps"), py::arg("last") = py::none(), py::arg("seed") = 0,
        "Virtual lights, each for several texels.");
    m.def(
        "bounce_maps",
        [](const BoundScene& s, const VirtualLights& lights, int size) {
            return run([&] { return std::make_shared<LightMaps>(bounce_maps(s.scene, *s.intersector, lights, size)); });
        },
        py::arg("scene"), py::arg("lights"), py::arg("size"), "What virtual lights see.");
    m.def(
        "join_lights",
        [](const std::vector<std::shared_ptr<VirtualLights>>& lists) {
            std::vector<const VirtualLights*> plain;
            for (const auto& list : lists) plain.push_back(list.get());
            return std::make_shared<VirtualLights>(join_lights(plain));
        },
        py::arg("lists"), "Several lists of lights as one.");
    m.def(
        "scatter_points",
        [](const ShadowLights& technique, const BoundScene& s) -> std::shared_ptr<SurfacePoints> {
            const auto* maps = std::get_if<ImperfectShadowMaps>(&technique);
            return run([&] {
                return std::make_shared<SurfacePoints>(maps != nullptr ? scatter_points(*maps, s.scene) : SurfacePoints{});
            });
        },
        py::arg("technique"), py::arg("scene"),
        "Points of a scene's surface for its lights' maps; none where there are no maps.");
    m.def(
        "shadow_lights",
        [](const ShadowLights& technique, const VirtualLights& lights, const SurfacePoints& points, const BoundScene& s) {
            return run([&] {
                return std::make_shared<LightShadows>(
                    std::visit([&](const auto& one) { return shadow_lights(one, lights, points, s.scene); }, technique));
            });
        },
        py::arg("technique"), py::arg("lights"), py::arg("points"), py::arg("scene"), "What virtual lights see.");
    m.def(
        "light_pixels",
        [](const ShadeLights& shade_by, const FilterShadows& filter, const Share& share, const VirtualLights& lights,
           const LightShadows& shadows, const GBuffer& gbuffer, const BoundScene& s, std::uint32_t seed) {
            return run([&] {
                return std::make_shared<VirtualLight>(
                    light_pixels(LightPixels{shade_by, filter, share, seed}, lights, shadows, gbuffer, s.scene, *s.intersector));
            });
        },
        py::arg("shade_lights"), py::arg("filter_shadows"), py::arg("share"), py::arg("lights"), py::arg("shadows"),
        py::arg("gbuffer"), py::arg("scene"), py::arg("seed") = 0, "All virtual lights at all pixels.");
}

}  // namespace

void bind_virtual_lights(py::module_& m) {
    bind_lights(m);
    bind_shadows(m);
    bind_light(m);
    bind_stages(m);
    bind_functions(m);
}

}  // namespace interreflect::bindings
