/// Room light_volumes: inject, propagate, look up.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "bindings/technique.h"
#include "light_volumes/inject.h"
#include "light_volumes/look_up.h"
#include "light_volumes/propagate.h"

namespace interreflect::bindings {

void bind_light_volumes(py::module_& m) {
    py::class_<LightVolume, std::shared_ptr<LightVolume>>(m, "LightVolume", "The light that passes through the cells of a grid.")
        .def_readonly("domain", &LightVolume::domain, "The grid.")
        .def_property_readonly(
            "coefficients",
            [](const py::object& self) {
                const auto& volume = self.cast<const LightVolume&>();
                const ivec3 cells = volume.domain.cells;
                return view(volume.coefficients.data(), {cells.z, cells.y, cells.x, 3, LightVolume::harmonics}, self);
            },
            "(z, y, x, 3, 4): radiant intensity of every cell, W/sr: of red, green and blue two bands of spherical harmonics, 1, "
            "y, z "
            "and x.")
        .def_readonly("counts", &LightVolume::counts)
        .def_property_readonly("bytes", &LightVolume::bytes);
    py::class_<GeometryVolume, std::shared_ptr<GeometryVolume>>(m, "GeometryVolume",
                                                                "Where surface blocks light between the cells of a grid.")
        .def_property_readonly(
            "coefficients",
            [](const py::object& self) {
                const auto& volume = self.cast<const GeometryVolume&>();
                const ivec3 corners = volume.corners();
                return view(volume.coefficients.data(), {corners.z, corners.y, corners.x, LightVolume::harmonics}, self);
            },
            "(z, y, x, 4), one more of each than cells: the share of light from a direction that is blocked at a corner, two "
            "bands of "
            "spherical harmonics, 1, y, z and x.")
        .def_readonly("counts", &GeometryVolume::counts)
        .def_property_readonly("bytes", &GeometryVolume::bytes);
    bind_stage(m, "propagate", "How light spreads from the cells of a grid to others.", false,
               static_cast<const Propagate*>(nullptr));
    m.def(
        "inject",
        [](const VirtualLights& lights, const Domain& domain) {
            return run([&] { return std::make_shared<LightVolume>(inject(lights, domain)); });
        },
        py::arg("lights"), py::arg("domain"),
        "The light that virtual lights send into the cells before them. ValueError for warped or nested grids, and above 4 GiB.");
    m.def(
        "geometry_volume",
        [](const Surfels& surfels, const Domain& domain) {
            return run([&] { return std::make_shared<GeometryVolume>(geometry_volume(surfels, domain)); });
        },
        py::arg("surfels"), py::arg("domain"), "Where surfels block light between the cells of a grid. ValueError as `inject`.");
    m.def(
        "propagate",
        [](const Propagate& technique, const LightVolume& injected, const GeometryVolume* blockers) {
            return run([&] {
                return std::make_shared<LightVolume>(
                    std::visit([&](const auto& one) { return propagate(one, injected, blockers); }, technique));
            });
        },
        py::arg("technique"), py::arg("injected"), py::arg("blockers") = py::none(),
        "The light that comes to every cell from others. blockers: None: nothing blocks; ValueError for another grid's.");
    m.def(
        "look_up",
        [](const LightVolume& volume, const GBuffer& gbuffer) {
            return run([&] { return std::make_shared<GatheredLight>(look_up(volume, gbuffer)); });
        },
        py::arg("volume"), py::arg("gbuffer"), "What comes to the pixels out of a light volume: irradiance alone.");
}

}  // namespace interreflect::bindings
