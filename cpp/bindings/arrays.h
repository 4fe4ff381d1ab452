/// Arrays between numpy and the core: checked views in, zero-copy views out.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>
#include <string>
#include <vector>

#include "data/buffer.h"
#include "math/vectors.h"

namespace interreflect::bindings {
namespace py = pybind11;

/// A C-contiguous array of `Scalar` without conversion; ValueError that names the argument otherwise.
template <class Scalar>
py::array_t<Scalar, py::array::c_style> exact_array(const py::object& object, const char* name) {
    if (!py::isinstance<py::array>(object)) throw py::value_error(std::string(name) + " must be a numpy array");
    const auto array = py::reinterpret_borrow<py::array>(object);
    if (!py::isinstance<py::array_t<Scalar>>(object))
        throw py::value_error(std::string(name) + " must have dtype " + py::str(py::dtype::of<Scalar>()).cast<std::string>() +
                              ", got " + py::str(array.dtype()).cast<std::string>());
    if ((array.flags() & py::array::c_style) == 0) throw py::value_error(std::string(name) + " must be C-contiguous");
    return py::reinterpret_borrow<py::array_t<Scalar, py::array::c_style>>(object);
}

/// The rows of an (n, columns) array as vectors, borrowed from numpy.
template <class Vector, class Scalar>
std::span<const Vector> rows(const py::object& object, const char* name) {
    constexpr auto columns = static_cast<py::ssize_t>(sizeof(Vector) / sizeof(Scalar));
    const auto array = exact_array<Scalar>(object, name);
    if (array.ndim() != 2 || array.shape(1) != columns)
        throw py::value_error(std::string(name) + " must have shape (n, " + std::to_string(columns) + ")");
    return {reinterpret_cast<const Vector*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

inline vec3 vector3(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }
inline std::array<float, 3> array3(const vec3& v) { return {v.x, v.y, v.z}; }

/// A read-only numpy view of `data` with the given shape; `owner` is kept alive by it.
template <class Scalar>
py::array_t<Scalar> view(const Scalar* data, std::vector<py::ssize_t> shape, py::handle owner) {
    py::array_t<Scalar> array(std::move(shape), data, owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}
/// The same of half floats.
inline py::array halves(const std::uint16_t* data, std::vector<py::ssize_t> shape, py::handle owner) {
    py::array array(py::dtype("e"), std::move(shape), data, owner);
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}
/// (n, components) of n vectors.
template <class T>
py::array_t<float> vectors(const Buffer<T>& data, py::handle owner) {
    return view(reinterpret_cast<const float*>(data.data()),
                {static_cast<py::ssize_t>(data.size()), static_cast<py::ssize_t>(sizeof(T) / sizeof(float))}, owner);
}
template <class T>
py::array_t<T> numbers(const Buffer<T>& data, py::handle owner) {
    return view(data.data(), {static_cast<py::ssize_t>(data.size())}, owner);
}
inline py::array_t<float> image_view(const Buffer<vec3>& data, int width, int height, py::handle owner) {
    return view(reinterpret_cast<const float*>(data.data()), {height, width, 3}, owner);
}
template <class Scalar>
py::array_t<Scalar> image_view(const Buffer<Scalar>& data, int width, int height, py::handle owner) {
    return view(data.data(), {height, width}, owner);
}

/// A (4, 4) float64 matrix; ValueError names it.
inline mat4 matrix4(const py::object& object, const char* name) {
    const auto array = exact_array<double>(object, name);
    if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4)
        throw py::value_error(std::string(name) + " must have shape (4, 4)");
    mat4 m;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) m[column][row] = static_cast<float>(array.at(row, column));
    return m;
}

/// None, or an array of marks.
struct Marks {
    py::array_t<std::uint8_t> array;  // keeps the values
    std::span<const std::uint8_t> values;

    Marks(const py::object& given, const char* name) {
        if (given.is_none()) return;
        array = exact_array<std::uint8_t>(given, name);
        values = {array.data(), static_cast<std::size_t>(array.size())};
    }
};

}  // namespace interreflect::bindings
