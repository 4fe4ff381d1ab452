#include <pybind11/pybind11.h>

#include "bindings/technique.h"
#include "brightest.h"

using Denoise = std::variant<interreflect::Brightest, interreflect::Median>;

PYBIND11_MODULE(_dummy, m) {
    m.attr("stages") = pybind11::dict();
    interreflect::bindings::bind_stage(m, "dummy", "A stage of tests.", true, static_cast<const Denoise*>(nullptr));
}
