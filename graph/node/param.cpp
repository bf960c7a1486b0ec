// SPDX-License-Identifier: Apache-2.0
#include "graph/node/param.hpp"

#include "dsp/core/units.hpp"
#include "graph/node/unit_of.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tactus {

Param::Param(std::string_view default_text, std::string_view min_text, std::string_view max_text, const char* about_)
    : unit(unit_of(default_text)), about(about_) {
    value = parse_as(default_text, unit);
    min = parse_as(min_text, unit);
    max = parse_as(max_text, unit);
}

double Param::parse(std::string_view text) const {
    const double v = parse_as(text, unit);
    if (v < min || v > max)
        throw Error(fmt::format("{} is outside {} … {}", text, format_quantity(min, unit), format_quantity(max, unit)));
    return v;
}

void Choice::set(std::string_view word) {
    for (std::size_t i = 0; i < options.size(); ++i)
        if (options[i] == word) {
            index = static_cast<int>(i);
            return;
        }
    throw Error(fmt::format("'{}' is not one of {}{}", word, fmt::join(options, ", "), did_you_mean(word, options)));
}

void Flag::set(std::string_view text) {
    if (text != "true" && text != "false") throw Error(fmt::format("'{}' is neither true nor false", text));
    value = text == "true";
}

Vector::Vector(std::string_view default_text, std::string_view about_)
    : unit(unit_of(default_text.substr(0, default_text.find(',')))), about(about_) {
    set(default_text);
}

void Vector::set(std::string_view text) {
    Vec3 v{0.0, 0.0, 0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = text.find(',');
        if ((comma == std::string_view::npos) != (axis == 2))
            throw Error("three quantities are needed, as in \"10 mm, 0 mm, 5 mm\"");
        v[axis] = parse_as(text.substr(0, comma), unit);
        text.remove_prefix(axis == 2 ? text.size() : comma + 1);
    }
    value = v;
}

}  // namespace tactus
