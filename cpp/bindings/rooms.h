/// One function a room: enters its techniques, values and functions in the module.
#pragma once
#include <pybind11/pybind11.h>

#include <memory>

#include "data/scene.h"
#include "visibility/intersector.h"

namespace interreflect::bindings {
namespace py = pybind11;

/// What Python holds as a scene: the plain data and the hierarchy over it.
struct BoundScene {
    Scene scene;
    std::shared_ptr<const Intersector> intersector;
};

void bind_data(py::module_& m);
void bind_visibility(py::module_& m);

}  // namespace interreflect::bindings
