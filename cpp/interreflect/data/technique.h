/// The one description of a technique: its name, what it does, where it comes from, and each knob's unit, range and meaning.
///
/// A technique is an aggregate whose fields are its knobs. Its `description` serves the Python class, repr, equality, pickle,
/// dict, sweep axis, range check, `interreflect techniques` and the docs; nothing is restated elsewhere. A knob is a double, int,
/// bool, std::string or another technique (a described struct, or a std::variant of them).
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>

namespace interreflect {

/// Where a technique was published, and where in it.
struct Source {
    std::string_view work, place = "";
};

/// What a knob counts in. Lengths are in texels, voxels, pixels, tiles or extents of the scene; angles in degrees.
enum class Unit { none, degrees, texels, voxels, pixels, tiles, extents, samples, diameters };

constexpr std::string_view unit_name(Unit unit) {
    constexpr std::string_view names[] = {"",      "degrees", "texels",  "voxels",   "pixels",
                                          "tiles", "extents", "samples", "diameters"};
    return names[static_cast<std::size_t>(unit)];
}

/// The values a knob may take: an interval, each end open or closed, or (for strings) a list of words separated by '|'.
struct Range {
    double minimum = -std::numeric_limits<double>::infinity();
    double maximum = std::numeric_limits<double>::infinity();
    bool open_minimum = false, open_maximum = false;
    std::string_view choices = "";
};
constexpr Range any_value() { return {}; }
constexpr Range at_least(double minimum) { return {minimum}; }
constexpr Range above(double minimum) { return {minimum, std::numeric_limits<double>::infinity(), true}; }
constexpr Range between(double minimum, double maximum) { return {minimum, maximum}; }
constexpr Range above_up_to(double minimum, double maximum) { return {minimum, maximum, true}; }
constexpr Range one_of(std::string_view choices) {
    Range range;
    range.choices = choices;
    return range;
}

template <class Technique, class Value>
struct Param {
    std::string_view name;
    Value Technique::*member;
    std::string_view doc;
    Unit unit = Unit::none;
    Range range = {};

    constexpr Param(std::string_view n, Value Technique::*m, std::string_view d, Unit u = Unit::none, Range r = {})
        : name(n), member(m), doc(d), unit(u), range(r) {}
};

/// Each is a Param of the technique, or of a struct that it derives from.
template <class... Params>
struct Description {
    std::string_view name, doc;
    Source source;
    std::tuple<Params...> params;
};

namespace detail {
template <class Technique, class Value>
constexpr std::tuple<Param<Technique, Value>> listed(const Param<Technique, Value>& param) {
    return {param};
}
template <class... Params>
constexpr std::tuple<Params...> listed(const std::tuple<Params...>& shared) {
    return shared;
}
template <class... Params>
constexpr Description<Params...> described(std::string_view name, std::string_view doc, Source source,
                                           std::tuple<Params...> params) {
    return {name, doc, source, params};
}
}  // namespace detail

/// From a technique's params, and tuples of those that it shares with others.
template <class... Params>
constexpr auto describe(std::string_view name, std::string_view doc, Source source, const Params&... params) {
    return detail::described(name, doc, source, std::tuple_cat(detail::listed(params)...));
}

template <class T>
concept Described = requires {
    T::description.name;
};

template <class T>
struct is_variant : std::false_type {};
template <class... T>
struct is_variant<std::variant<T...>> : std::true_type {};

/// Calls f(param) for each knob of a technique, in order.
template <Described T, class F>
constexpr void for_each_param(F&& f) {
    std::apply([&](const auto&... param) { (f(param), ...); }, T::description.params);
}

/// "(0, 89]", or "one of a, b".
std::string range_text(const Range& range);
/// Whether `value` is one of the words of `choices`.
bool is_choice(std::string_view choices, std::string_view value);

namespace detail {
[[noreturn]] void out_of_range(std::string_view technique, std::string_view knob, const Range& range, Unit unit,
                               const std::string& value);

template <class Value>
void check_value(std::string_view technique, std::string_view knob, const Range& range, Unit unit, const Value& value) {
    if constexpr (std::is_same_v<Value, std::string>) {
        if (!range.choices.empty() && !is_choice(range.choices, value))
            out_of_range(technique, knob, range, unit, "'" + value + "'");
    } else {
        const auto v = static_cast<double>(value);
        const bool inside = (range.open_minimum ? v > range.minimum : v >= range.minimum) &&
                            (range.open_maximum ? v < range.maximum : v <= range.maximum);
        if (inside && std::isfinite(v)) return;
        std::ostringstream text;
        text.precision(std::numeric_limits<double>::max_digits10 - 1);
        text << value;
        out_of_range(technique, knob, range, unit, text.str());
    }
}
}  // namespace detail

/// Throws std::invalid_argument, naming technique, knob, bound and value, unless every knob lies in its range.
template <Described T>
void check(const T& technique) {
    for_each_param<T>([&](const auto& param) {
        const auto& value = technique.*param.member;
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (is_variant<Value>::value) {
            std::visit([](const auto& inner) { check(inner); }, value);
        } else if constexpr (Described<Value>) {
            check(value);
        } else if constexpr (!std::is_same_v<Value, bool>) {
            detail::check_value(T::description.name, param.name, param.range, param.unit, value);
        }
    });
}

}  // namespace interreflect
