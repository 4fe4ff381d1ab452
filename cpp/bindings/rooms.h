/// One function a room: enters its techniques, values and functions in the module.
#pragma once
#include <pybind11/pybind11.h>

#include <memory>

#include "data/scene.h"
#include "shading/lights.h"
#include "visibility/intersector.h"

namespace interreflect::bindings {
namespace py = pybind11;

/// What Python holds as a scene: the plain data, the hierarchy over it and its lights.
struct BoundScene {
    Scene scene;
    std::shared_ptr<const Intersector> intersector;
    std::shared_ptr<const LightSampler> lights;  // of `scene`, which it refers to
};

void bind_data(py::module_& m);
/// Scenes are bound by bind_visibility, between the ray hierarchy that they hold and the functions that take them.
void bind_scene(py::module_& m);
void bind_shading(py::module_& m);
void bind_visibility(py::module_& m);
void bind_direct(py::module_& m);
void bind_reference(py::module_& m);
void bind_voxels(py::module_& m);
void bind_march(py::module_& m);
void bind_caches(py::module_& m);
void bind_virtual_lights(py::module_& m);
void bind_light_volumes(py::module_& m);
void bind_surfel_data(py::module_& m);
void bind_surfels(py::module_& m);
void bind_frame_links(py::module_& m);
void bind_stored_surfels(py::module_& m);
void bind_calibration(py::module_& m);

}  // namespace interreflect::bindings
