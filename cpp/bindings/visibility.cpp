/// Room visibility: the ray hierarchy and what the camera sees.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <string>

#include "bindings/arrays.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "shading/shade.h"
#include "visibility/trace_gbuffer.h"

namespace interreflect::bindings {
namespace {

/// A read-only property that shows one of the G-buffer's images without a copy.
template <class T>
void image_property(py::class_<GBuffer, std::shared_ptr<GBuffer>>& cls, const char* name, Buffer<T> GBuffer::*image,
                    const char* doc) {
    cls.def_property_readonly(
        name,
        [image](const py::object& self) {
            const auto& g = self.cast<const GBuffer&>();
            return image_view(g.*image, g.width, g.height, self);
        },
        doc);
}

std::size_t gbuffer_bytes(const GBuffer& g) {
    return g.position.bytes() + g.geometric_normal.bytes() + g.normal.bytes() + g.albedo.bytes() + g.specular.bytes() +
           g.emission.bytes() + g.alpha.bytes() + g.depth.bytes() + g.offset.bytes() + g.triangle.bytes() + g.instance.bytes() +
           g.body.bytes();
}

void bind_gbuffer(py::module_& m) {
    py::class_<GBuffer, std::shared_ptr<GBuffer>> cls(
        m, "GBuffer", "What the camera sees through every pixel's centre: read-only views of (height, width[, 3]) arrays.");
    cls.def_readonly("width", &GBuffer::width).def_readonly("height", &GBuffer::height).def_readonly("camera", &GBuffer::camera);
    image_property(cls, "position", &GBuffer::position, "World space; (0, 0, 0) where nothing was hit.");
    image_property(cls, "geometric_normal", &GBuffer::geometric_normal,
                   "Unit, towards the camera; (0, 0, 0) where nothing was hit.");
    image_property(cls, "normal", &GBuffer::normal, "Shading normal: unit, towards the camera.");
    image_property(cls, "albedo", &GBuffer::albedo, "Diffuse reflectance, texture filtered by the pixel's footprint.");
    image_property(cls, "specular", &GBuffer::specular, "Reflectance of the glossy lobe at normal incidence.");
    image_property(cls, "emission", &GBuffer::emission,
                   "Radiance towards the camera, W/(m^2 sr); the environment's where nothing was hit.");
    image_property(cls, "alpha", &GBuffer::alpha, "GGX width: roughness squared, or sqrt(2 / (exponent + 2)).");
    image_property(cls, "depth", &GBuffer::depth, "Distance along the ray, scene units; infinite where nothing was hit.");
    image_property(cls, "offset", &GBuffer::offset, "How far off the surface rays start, scene units.");
    image_property(cls, "triangle", &GBuffer::triangle, "Global number of the triangle; 2^32 - 1 where nothing was hit.");
    image_property(cls, "instance", &GBuffer::instance, "Number of the instance; 2^32 - 1 where nothing was hit.");
    image_property(cls, "body", &GBuffer::body, "Number of the body; 0 is \"world\".");
    cls.def_readonly("counts", &GBuffer::counts).def_property_readonly("bytes", &gbuffer_bytes, "Memory the images hold.");
    m.def(
        "trace_gbuffer",
        [](const BoundScene& scene, const Camera& camera, int width, int height, const Shade& shade) {
            return run([&] {
                auto g = std::make_shared<GBuffer>(trace_gbuffer(scene.scene, *scene.intersector, camera, width, height));
                g->lobe = lobe_of(shade);
                return g;
            });
        },
        py::arg("scene"), py::arg("camera"), py::arg("width"), py::arg("height"), py::arg("shade") = Exact{},
        "The G-buffer by primary rays through pixel centres; textures are filtered by the pixel's footprint. shade: how its "
        "surfaces "
        "reflect.");
}

}  // namespace

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
    bind_scene(m);
    bind_gbuffer(m);
}

}  // namespace interreflect::bindings
