#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdlib>

#include "bindings/rooms.h"
#include "bindings/run.h"
#include "math/vector_target.h"
#include "sources_digest.h"

namespace py = pybind11;
using namespace interreflect::bindings;

namespace {
/// `with threads(n):` work inside uses at most n threads (None or 0: all).
struct Threads {
    int limit = 0, before = 0;
};

/// Before any kernel runs, so that all of them run on the same target.
void choose_vectors() {
    const char* name = std::getenv("INTERREFLECT_VECTORS");
    if (name == nullptr) return;
    try {
        interreflect::force_vector_target(name);
    } catch (const std::invalid_argument& problem) {
        throw py::import_error(std::string("INTERREFLECT_VECTORS ") + problem.what());
    }
}
}  // namespace

PYBIND11_MODULE(_core, m) {
    choose_vectors();
    m.doc() = "The core of Interreflect: stages on plain data.";
    m.attr("stages") = py::dict();
    m.def(
        "_rebuild", [](const py::object& cls, const py::dict& knobs) { return cls(**knobs); },
        "Makes a technique again from its knobs (pickle).");
    m.attr("build_info") = py::dict(py::arg("version") = INTERREFLECT_VERSION, py::arg("commit") = INTERREFLECT_COMMIT,
                                    py::arg("compiler") = "g++ " __VERSION__, py::arg("flags") = INTERREFLECT_FLAGS,
                                    py::arg("sources") = INTERREFLECT_SOURCES);
    py::class_<Threads>(m, "Threads", "Context manager: work inside uses at most `limit` threads; None: all.")
        .def(py::init([](const std::optional<int>& limit) {
                 if (limit && *limit < 1) throw py::value_error("threads must be at least 1, got " + std::to_string(*limit));
                 return Threads{limit.value_or(0)};
             }),
             py::arg("limit") = py::none())
        .def("__enter__", [](Threads& self) { self.before = thread_limit(), thread_limit() = self.limit; })
        .def("__exit__",
             [](Threads& self, const py::object&, const py::object&, const py::object&) { thread_limit() = self.before; });
    m.def(
        "thread_limit", [] { return thread_limit(); }, "How many threads work of the calling thread may use; 0: all.");
    bind_data(m);
    bind_shading(m);
    bind_visibility(m);
    bind_reference(m);
    bind_voxels(m);
    bind_direct(m);
    bind_march(m);
    bind_caches(m);
    bind_virtual_lights(m);
    bind_surfels(m);
    bind_frame_links(m);
    bind_stored_surfels(m);
    bind_light_volumes(m);
    bind_calibration(m);
}
