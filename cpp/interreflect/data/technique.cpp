#include "data/technique.h"

namespace interreflect {

bool is_choice(std::string_view choices, std::string_view value) {
    while (true) {
        const auto bar = choices.find('|');
        if (choices.substr(0, bar) == value) return true;
        if (bar == std::string_view::npos) return false;
        choices.remove_prefix(bar + 1);
    }
}

std::string range_text(const Range& range) {
    std::ostringstream text;
    if (!range.choices.empty()) {
        text << "one of ";
        for (const char c : range.choices) c == '|' ? text << ", " : text << c;
    } else {
        text << (range.open_minimum || std::isinf(range.minimum) ? '(' : '[') << range.minimum << ", " << range.maximum
             << (range.open_maximum || std::isinf(range.maximum) ? ')' : ']');
    }
    return text.str();
}

namespace detail {
void out_of_range(std::string_view technique, std::string_view knob, const Range& range, Unit unit, const std::string& value) {
    std::ostringstream text;
    text << technique << '.' << knob << (range.choices.empty() ? " must lie in " : " must be ") << range_text(range);
    if (unit != Unit::none) text << ' ' << unit_name(unit);
    text << ", got " << value;
    throw std::invalid_argument(text.str());
}
}  // namespace detail

}  // namespace interreflect
