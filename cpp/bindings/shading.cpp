/// Room shading: how surfaces reflect, and how pixels share work.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/rooms.h"
#include "bindings/technique.h"
#include "shading/shade.h"
#include "shading/share.h"

namespace interreflect::bindings {

void bind_shading(py::module_& m) {
    bind_stage(m, "shade", "How glossy surfaces reflect direct and indirect light.", true, static_cast<const Shade*>(nullptr));
    bind_stage(m, "share", "Which part of a pixel's work it does itself, and how the rest is taken from its neighbours.", true,
               static_cast<const Share*>(nullptr));
}

}  // namespace interreflect::bindings
