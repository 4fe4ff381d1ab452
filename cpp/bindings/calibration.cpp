/// What this machine can do at most: bandwidths, arithmetic, rays.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "bindings/rooms.h"
#include "bindings/run.h"
#include "math/throughput.h"
#include "math/vector_target.h"
#include "visibility/ray_rate.h"

namespace interreflect::bindings {

void bind_calibration(py::module_& m) {
    const auto bandwidth = [&m](const char* name, double (*measure)(int, std::size_t), const char* doc) {
        m.def(
            name,
            [measure](int repeats, int mebibytes) { return run([&] { return measure(repeats, std::size_t(mebibytes) << 18); }); },
            py::arg("repeats"), py::arg("mebibytes") = static_cast<int>(throughput_floats >> 18), doc);
    };
    bandwidth("read_bandwidth", &read_bandwidth, "GB/s of reading an array of `mebibytes`, best of `repeats`.");
    bandwidth("triad_bandwidth", &triad_bandwidth, "GB/s of a = b + s c over arrays of `mebibytes` each, best of `repeats`.");
    m.def(
        "multiply_add_rate", [](int repeats) { return run([&] { return multiply_add_rate(repeats); }); }, py::arg("repeats"),
        "Single-precision GFLOP/s of fused multiply-adds, best of `repeats`.");
    m.def(
        "cone_step_rate", [](int repeats) { return run([&] { return cone_step_rate(repeats); }); }, py::arg("repeats"),
        "Million steps of cones a second, each two trilinear look-ups in a pyramid of half floats; best of `repeats`.");
    m.def("vector_bytes", &vector_bytes, "Bytes of the vectors that kernels run on.");
    m.def("vector_target", &vector_target,
          "What kernels run on: sse4, avx2 or avx512; the environment's INTERREFLECT_VECTORS forces one.");
    m.def("vector_targets", &vector_targets, "What kernels can run on here, narrowest first.");
    m.def(
        "ray_rates",
        [](int repeats) {
            const RayRates rates = run([&] { return measure_ray_rates(repeats); });
            return py::dict(py::arg("coherent") = rates.coherent, py::arg("incoherent") = rates.incoherent,
                            py::arg("occlusion") = rates.occlusion);
        },
        py::arg("repeats"),
        "Million rays a second inside a rough sphere of 131,072 triangles, best of `repeats`, by kind of ray.");
}

}  // namespace interreflect::bindings
