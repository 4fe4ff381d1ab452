#include "bindings/technique.h"

namespace interreflect::bindings {

void refuse_unknown(const py::kwargs& given, const py::list& known, std::string_view technique) {
    for (const auto& item : given) {
        if (known.contains(item.first)) continue;
        const auto near = py::module_::import("difflib").attr("get_close_matches")(item.first, known, 1, 0.5).cast<py::list>();
        std::string text = std::string(technique) + " has no knob '" + item.first.cast<std::string>() + "'";
        if (!near.empty())
            text += "; did you mean '" + near[0].cast<std::string>() + "'?";
        else if (known.empty())
            text += "; it has none";
        else
            text += "; it has " + py::str(", ").attr("join")(known).cast<std::string>();
        throw py::type_error(text);
    }
}

void add_stage(const py::object& cls, const char* stage) {
    auto stages = py::list(cls.attr("stages"));
    if (!stages.contains(py::str(stage))) stages.append(py::str(stage));
    cls.attr("stages") = py::tuple(stages);
}

py::dict describe_param(std::string_view name, std::string_view doc, Unit unit, const Range& range, const std::string& type,
                        const py::object& default_value, const py::object& techniques) {
    py::dict dict;
    dict["name"] = std::string(name);
    dict["doc"] = std::string(doc);
    dict["type"] = type;
    dict["unit"] = std::string(unit_name(unit));
    dict["default"] = default_value;
    const bool number = type == "int" || type == "float";
    dict["minimum"] = number && std::isfinite(range.minimum) ? py::object(py::float_(range.minimum)) : py::object(py::none());
    dict["maximum"] = number && std::isfinite(range.maximum) ? py::object(py::float_(range.maximum)) : py::object(py::none());
    dict["open_minimum"] = range.open_minimum;
    dict["open_maximum"] = range.open_maximum;
    dict["choices"] = range.choices.empty() ? py::object(py::tuple())
                                            : py::object(py::tuple(py::str(std::string(range.choices)).attr("split")("|")));
    dict["techniques"] = techniques;
    std::string text = std::string(doc) + " (" + type;
    if (number && (std::isfinite(range.minimum) || std::isfinite(range.maximum))) text += " in " + range_text(range);
    if (!range.choices.empty()) text += ", " + range_text(range);
    if (unit != Unit::none) text += ", " + std::string(unit_name(unit));
    dict["text"] = text + "; default " + py::repr(default_value).cast<std::string>() + ")";
    return dict;
}

void wrong_type(std::string_view technique, std::string_view knob, const char* expected, const py::handle& got) {
    throw py::type_error(std::string(technique) + "." + std::string(knob) + " must be " + expected + ", got " +
                         py::repr(got).cast<std::string>());
}

}  // namespace interreflect::bindings
