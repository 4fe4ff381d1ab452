/// The voxel hierarchies that a stage takes from Python.
#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <vector>

#include "data/voxel_grid.h"

namespace interreflect::bindings {
namespace py = pybind11;

/// ValueError where there is none, TypeError for None among them.
inline std::vector<const Pyramid*> plain_pointers(const std::vector<std::shared_ptr<const Pyramid>>& pyramids) {
    if (pyramids.empty()) throw py::value_error("pyramids must hold at least one Pyramid");
    std::vector<const Pyramid*> each;
    for (const auto& pyramid : pyramids) {
        if (pyramid == nullptr) throw py::type_error("pyramids must be Pyramids, got None");
        each.push_back(pyramid.get());
    }
    return each;
}

}  // namespace interreflect::bindings
