/// Room reference: the path tracer.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <string>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "reference/path_tracing.h"

namespace interreflect::bindings {
namespace {

std::shared_ptr<PathTraced> trace(const BoundScene& scene, const Camera& camera, int width, int height, int samples,
                                  std::optional<double> milliseconds, std::optional<int> bounces, const std::string& pixel,
                                  int pattern, std::uint32_t seed) {
    static const std::map<std::string, PixelFilter> filters{{"centre", PixelFilter::centre}, {"box", PixelFilter::box}};
    if (!filters.contains(pixel)) throw py::value_error("pixel must be one of centre, box, got '" + pixel + "'");
    const PathTracingSettings settings{samples, milliseconds, bounces, filters.at(pixel), pattern, seed};
    return run([&] {
        return std::make_shared<PathTraced>(
            path_trace(scene.scene, *scene.intersector, *scene.lights, camera, width, height, settings));
    });
}

}  // namespace

void bind_reference(py::module_& m) {
    py::class_<PathTraced, std::shared_ptr<PathTraced>>(
        m, "PathTraced", "Radiance of every pixel, W/(m^2 sr): read-only (height, width, 3) views.")
        .def_property_readonly(
            "direct",
            [](const py::object& self) {
                const auto& p = self.cast<const PathTraced&>();
                return image_view(p.direct, p.width, p.height, self);
            },
            "Emission, the environment seen directly, and light reflected once.")
        .def_property_readonly(
            "indirect",
            [](const py::object& self) {
                const auto& p = self.cast<const PathTraced&>();
                return image_view(p.indirect, p.width, p.height, self);
            },
            "Light reflected more than once.")
        .def_property_readonly(
            "certain",
            [](const py::object& self) -> py::object {
                const auto& p = self.cast<const PathTraced&>();
                if (p.certain.empty()) return py::none();
                return image_view(p.certain, p.width, p.height, self);
            },
            "Through pixel centres, the part of `direct` that has no noise: emission and point, spot and directional lights. "
            "None with the box filter.")
        .def_readonly("samples", &PathTraced::samples, "Paths that every pixel got.")
        .def_readonly("counts", &PathTraced::counts)
        .def_property_readonly(
            "bytes", [](const PathTraced& p) { return p.direct.bytes() + p.indirect.bytes() + p.certain.bytes(); },
            "Memory the images hold.");
    m.def("path_trace", &trace, py::arg("scene"), py::arg("camera"), py::arg("width"), py::arg("height"), py::kw_only(),
          py::arg("samples") = 1, py::arg("milliseconds") = py::none(), py::arg("bounces") = 1, py::arg("pixel") = "centre",
          py::arg("pattern") = 8, py::arg("seed") = 0,
          "Path tracing with exactly `bounces` indirect bounces (None: all); `samples` paths a pixel, fewer where `milliseconds` "
          "end sooner.");
}

}  // namespace interreflect::bindings
