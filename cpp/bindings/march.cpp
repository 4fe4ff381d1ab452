/// Room voxels, second half, and sharing: march, glossy, share, shade.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/pyramids.h"
#include "bindings/rooms.h"
#include "bindings/run.h"
#include "bindings/technique.h"
#include "shading/shade.h"
#include "voxels/glossy.h"
#include "voxels/march.h"

namespace interreflect::bindings {
namespace {

template <class Light, class T>
void image_property(py::class_<Light, std::shared_ptr<Light>>& cls, const char* name, Buffer<T> Light::*image, const char* doc) {
    cls.def_property_readonly(
        name,
        [image](const py::object& self) -> py::object {
            const auto& light = self.cast<const Light&>();
            if ((light.*image).empty()) return py::none();  // virtual lights bring no sky and no occlusion
            return image_view(light.*image, light.width, light.height, self);
        },
        doc);
}

void bind_lights_gathered(py::module_& m) {
    py::class_<GatheredLight, std::shared_ptr<GatheredLight>> gathered(
        m, "GatheredLight",
        "What arrives at the pixels over the hemisphere about the shading normal; zero where nothing was hit.");
    image_property(gathered, "irradiance", &GatheredLight::irradiance,
                   "(height, width, 3): of light that surfaces reflect, W/m^2.");
    image_property(gathered, "sky", &GatheredLight::sky, "(height, width, 3): of the environment through the openings, W/m^2.");
    image_property(gathered, "occlusion", &GatheredLight::occlusion,
                   "(height, width): cosine-weighted share of the hemisphere that is closed.");
    gathered.def_readonly("counts", &GatheredLight::counts).def_property_readonly("bytes", &GatheredLight::bytes);

    py::class_<GlossyLight, std::shared_ptr<GlossyLight>> glossy(m, "GlossyLight",
                                                                 "What the pixels' glossy lobe reflects towards the camera.");
    image_property(glossy, "radiance", &GlossyLight::radiance,
                   "(height, width, 3): of light that surfaces reflected, W/(m^2 sr).");
    image_property(glossy, "sky", &GlossyLight::sky, "(height, width, 3): of the environment, W/(m^2 sr).");
    glossy.def_readonly("counts", &GlossyLight::counts).def_property_readonly("bytes", &GlossyLight::bytes);
}

/// An image that numpy owns.
py::array_t<float> owned_image(Buffer<vec3> pixels, int width, int height) {
    auto held = std::make_unique<Buffer<vec3>>(std::move(pixels));
    const auto* data = reinterpret_cast<const float*>(held->data());
    const py::capsule owner(held.release(), [](void* buffer) { delete static_cast<Buffer<vec3>*>(buffer); });
    return py::array_t<float>({height, width, 3}, data, owner);
}

}  // namespace

void bind_march(py::module_& m) {
    bind_lights_gathered(m);
    bind_stage(m, "march", "Light that arrives over the hemisphere at the pixels, from the voxels and through openings.", true,
               static_cast<const March*>(nullptr));
    bind_stage(m, "glossy", "Light that the pixels' glossy lobe reflects towards the camera.", true,
               static_cast<const Glossy*>(nullptr));
    m.def(
        "march",
        [](const March& technique, const std::vector<std::shared_ptr<const Pyramid>>& pyramids, const GBuffer& gbuffer,
           const BoundScene& scene, const Share& share, std::uint32_t seed) {
            const auto each = plain_pointers(pyramids);
            return run([&] {
                return std::make_shared<GatheredLight>(std::visit(
                    [&](const auto& one) { return march(one, each, gbuffer, scene.scene, *scene.intersector, share, seed); },
                    technique));
            });
        },
        py::arg("technique"), py::arg("pyramids"), py::arg("gbuffer"), py::arg("scene"), py::arg("share"), py::arg("seed"),
        "Light that arrives over the hemisphere at the pixels.");
    m.def(
        "glossy",
        [](const Glossy& technique, const std::vector<std::shared_ptr<const Pyramid>>& pyramids, const GBuffer& gbuffer,
           const BoundScene& scene, std::uint32_t seed) {
            const auto each = plain_pointers(pyramids);
            return run([&] {
                return std::make_shared<GlossyLight>(
                    std::visit([&](const auto& one) { return glossy(one, each, gbuffer, scene.scene, *scene.intersector, seed); },
                               technique));
            });
        },
        py::arg("technique"), py::arg("pyramids"), py::arg("gbuffer"), py::arg("scene"), py::arg("seed"),
        "Light that the glossy lobe reflects.");
    m.def(
        "shade",
        [](const GBuffer& gbuffer, const GatheredLight& gathered, const GlossyLight* glossy) {
            return owned_image(run([&] { return shade(gbuffer, gathered, glossy); }), gbuffer.width, gbuffer.height);
        },
        py::arg("gbuffer"), py::arg("gathered"), py::arg("glossy") = py::none(),
        "(height, width, 3): indirect light that leaves the pixels' surfaces towards the camera.");
}

}  // namespace interreflect::bindings
