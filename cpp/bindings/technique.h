/// A technique as a Python class, made from its description: keyword-only, read-only, hashable, picklable.
#pragma once
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <type_traits>
#include <variant>

#include "data/technique.h"

namespace interreflect::bindings {
namespace py = pybind11;

/// Throws a TypeError for a keyword that names no knob, with the nearest name.
void refuse_unknown(const py::kwargs& given, const py::list& known, std::string_view technique);
/// Adds a stage's name to a class's `stages`.
void add_stage(const py::object& cls, const char* stage);
/// The dict that describes one knob.
py::dict describe_param(std::string_view name, std::string_view doc, Unit unit, const Range& range, const std::string& type,
                        const py::object& default_value, const py::object& techniques);
[[noreturn]] void wrong_type(std::string_view technique, std::string_view knob, const char* expected, const py::handle& got);

template <class Value>
constexpr const char* knob_type() {
    if constexpr (std::is_same_v<Value, bool>)
        return "bool";
    else if constexpr (std::is_same_v<Value, int>)
        return "int";
    else if constexpr (std::is_same_v<Value, double>)
        return "float";
    else if constexpr (std::is_same_v<Value, std::string>)
        return "str";
    else
        return "technique";
}

/// One knob from Python; booleans are no numbers and numbers no booleans.
template <class Value>
Value read_knob(std::string_view technique, std::string_view knob, const py::handle& given) {
    if constexpr (std::is_same_v<Value, bool>) {
        if (!py::isinstance<py::bool_>(given)) wrong_type(technique, knob, "a bool", given);
        return given.cast<bool>();
    } else if constexpr (std::is_same_v<Value, int>) {
        if (py::isinstance<py::bool_>(given) || PyIndex_Check(given.ptr()) == 0) wrong_type(technique, knob, "an int", given);
        const auto wide = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
        int overflow = 0;
        const long value = PyLong_AsLongAndOverflow(wide.ptr(), &overflow);
        if (overflow != 0 || value != static_cast<int>(value))
            throw py::value_error(std::string(technique) + "." + std::string(knob) + " must fit in 32 bits, got " +
                                  py::str(wide).cast<std::string>());
        return static_cast<int>(value);
    } else if constexpr (std::is_same_v<Value, double>) {
        if (py::isinstance<py::bool_>(given) || py::isinstance<py::str>(given) || PyNumber_Check(given.ptr()) == 0)
            wrong_type(technique, knob, "a number", given);
        const double value = PyFloat_AsDouble(given.ptr());
        if (value == -1.0 && PyErr_Occurred() != nullptr) {
            PyErr_Clear();
            wrong_type(technique, knob, "a number", given);
        }
        return value;
    } else if constexpr (std::is_same_v<Value, std::string>) {
        if (!py::isinstance<py::str>(given)) wrong_type(technique, knob, "a string", given);
        return given.cast<std::string>();
    } else {
        try {
            return given.cast<Value>();
        } catch (const py::cast_error&) {
            wrong_type(technique, knob, "a technique of that stage", given);
        }
    }
}

/// The classes that a technique-valued knob accepts.
template <class Value>
struct accepted {
    static py::tuple classes() {
        if constexpr (Described<Value>)
            return py::make_tuple(py::type::of<Value>());
        else
            return py::tuple();
    }
};
template <class... T>
struct accepted<std::variant<T...>> {
    static py::tuple classes() { return py::make_tuple(py::type::of<T>()...); }
};

template <Described T>
py::object bind_technique(py::module_& m);

/// Binds the techniques that a knob may hold: they must be known before the one that holds them.
template <class Value>
struct held {
    static void bind(py::module_& m) {
        if constexpr (Described<Value>) bind_technique<Value>(m);
    }
};
template <class... T>
struct held<std::variant<T...>> {
    static void bind(py::module_& m) { (bind_technique<T>(m), ...); }
};

/// Binds a technique once; a later call returns the same class.
template <Described T>
py::object bind_technique(py::module_& m) {
    const auto name = std::string(T::description.name);
    if (py::hasattr(m, name.c_str())) return m.attr(name.c_str());
    for_each_param<T>([&](const auto& param) { held<std::remove_cvref_t<decltype(std::declval<T>().*param.member)>>::bind(m); });

    auto cls = py::class_<T>(m, name.c_str(), py::is_final());
    py::list names;
    for_each_param<T>([&](const auto& param) { names.append(std::string(param.name)); });

    cls.def(py::init([names](const py::kwargs& given) {
        refuse_unknown(given, names, T::description.name);
        T made{};
        for_each_param<T>([&](const auto& param) {
            using Value = std::remove_cvref_t<decltype(made.*param.member)>;
            const auto key = py::str(std::string(param.name));
            if (given.contains(key)) made.*param.member = read_knob<Value>(T::description.name, param.name, given[key]);
        });
        check(made);
        return made;
    }));

    const T defaults{};
    py::list described;
    std::string doc = std::string(T::description.doc) + "\n\nSource: " + std::string(T::description.source.work);
    if (!T::description.source.place.empty()) doc += ", " + std::string(T::description.source.place);
    doc += "\n";
    for_each_param<T>([&](const auto& param) {
        using Value = std::remove_cvref_t<decltype(defaults.*param.member)>;
        const auto knob = std::string(param.name);
        const auto member = param.member;
        cls.def_property_readonly(
            knob.c_str(), [member](const T& self) { return py::cast(self.*member); }, std::string(param.doc).c_str());
        const py::dict one = describe_param(param.name, param.doc, param.unit, param.range, knob_type<Value>(),
                                            py::cast(defaults.*member), accepted<Value>::classes());
        described.append(one);
        doc += "\n" + knob + ": " + one["text"].template cast<std::string>();
    });
    cls.attr("__doc__") = doc;

    py::dict description;
    description["name"] = name;
    description["doc"] = std::string(T::description.doc);
    description["source"] = std::string(T::description.source.work);
    description["place"] = std::string(T::description.source.place);
    description["params"] = py::tuple(described);
    cls.attr("description") = description;
    cls.attr("stages") = py::tuple();

    const auto values = [](const T& self) {
        py::list list;
        for_each_param<T>([&](const auto& param) { list.append(py::cast(self.*param.member)); });
        return py::tuple(list);
    };
    cls.def("__repr__", [name](const T& self) {
        std::string text = name + "(", comma;
        for_each_param<T>([&](const auto& param) {
            text += comma + std::string(param.name) + "=" + py::repr(py::cast(self.*param.member)).template cast<std::string>();
            comma = ", ";
        });
        return text + ")";
    });
    cls.def(
        "__eq__", [](const T& a, const py::object& b) { return py::isinstance<T>(b) && a == b.cast<const T&>(); },
        py::is_operator());
    cls.def("__hash__", [name, values](const T& self) { return py::hash(py::make_tuple(name, values(self))); });
    cls.def(
        "asdict",
        [name](const T& self) {
            py::dict dict;
            dict["technique"] = name;
            for_each_param<T>([&](const auto& param) {
                const auto value = py::cast(self.*param.member);
                dict[py::str(std::string(param.name))] =
                    py::hasattr(value, "asdict") ? py::object(value.attr("asdict")()) : py::object(value);
            });
            return dict;
        },
        "Name and knobs as a dict; nested techniques as dicts of the same form.");
    const auto keywords = [](const T& self) {
        py::dict dict;
        for_each_param<T>([&](const auto& param) { dict[py::str(std::string(param.name))] = py::cast(self.*param.member); });
        return dict;
    };
    cls.def(
        "replace",
        [keywords](const py::object& self, const py::kwargs& changes) {
            const py::dict all = keywords(self.cast<const T&>());
            for (const auto& item : changes) all[item.first] = item.second;
            return py::type::of(self)(**all);
        },
        "The same technique with some knobs changed.");
    cls.def("_repr_html_",
            [](const py::object& self) { return py::module_::import("interreflect.display").attr("technique")(self); });
    cls.def("__reduce__", [keywords](const py::object& self) {
        const auto rebuild = py::module_::import("interreflect._core").attr("_rebuild");
        return py::make_tuple(rebuild, py::make_tuple(py::type::of(self), keywords(self.cast<const T&>())));
    });
    return cls;
}

/// Binds a stage's closed list and enters it in `_core.stages`: a dict of name -> {"doc", "techniques", "exact"}. The first of
/// the list is the exact counterpart where `has_exact`.
template <class... T>
void bind_stage(py::module_& m, const char* stage, const char* doc, bool has_exact, const std::variant<T...>*) {
    const py::tuple classes = py::make_tuple(bind_technique<T>(m)...);
    for (const auto& cls : classes) add_stage(py::reinterpret_borrow<py::object>(cls), stage);
    py::dict entry;
    entry["doc"] = doc;
    entry["techniques"] = classes;
    entry["exact"] = has_exact ? py::object(classes[0]) : py::object(py::none());
    m.attr("stages")[stage] = entry;
}

}  // namespace interreflect::bindings
