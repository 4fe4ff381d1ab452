/// Room visibility: the ray hierarchy and what the camera sees.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <string>

#include "bindings/rooms.h"
#include "bindings/run.h"

namespace interreflect::bindings {

void bind_visibility(py::module_& m) {
    py::class_<Intersector, std::shared_ptr<Intersector>>(m, "Intersector", "The ray hierarchy over a geometry.")
        .def(py::init([](std::shared_ptr<Geometry> geometry, const std::vector<Material>& materials,
                         const std::vector<std::shared_ptr<Mask>>& masks, const std::string& quality) {
                 static const std::map<std::string, BuildQuality> qualities{
                     {"low", BuildQuality::low}, {"medium", BuildQuality::medium}, {"high", BuildQuality::high}};
                 if (!qualities.contains(quality))
                     throw py::value_error("quality must be one of low, medium, high, got '" + quality + "'");
                 const std::vector<std::shared_ptr<const Mask>> solid(masks.begin(), masks.end());
                 return run([&] { return std::make_shared<Intersector>(geometry, materials, solid, qualities.at(quality)); });
             }),
             py::arg("geometry"), py::arg("materials"), py::arg("masks"), py::arg("quality") = "medium")
        .def(
            "moved",
            [](const Intersector& self, std::shared_ptr<Geometry> geometry) {
                return run([&] { return std::make_shared<Intersector>(self, geometry); });
            },
            py::arg("geometry"), "The same hierarchies with the instances where `geometry` has them.")
        .def_property_readonly("bytes", &Intersector::bytes);
}

}  // namespace interreflect::bindings
