// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/units.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

namespace tactus {

namespace {

struct Named {
    std::string_view symbol;
    double factor;
    std::array<std::int8_t, Dimension::base_count> exponent;  // m, kg, s, A, rad, HU, K
    bool prefixed;                                            // takes SI prefixes
};

constexpr Named named_units[] = {
    {"m", 1.0, {1, 0, 0, 0, 0, 0}, true},
    {"g", 1e-3, {0, 1, 0, 0, 0, 0}, true},
    {"s", 1.0, {0, 0, 1, 0, 0, 0}, true},
    {"A", 1.0, {0, 0, 0, 1, 0, 0}, true},
    {"rad", 1.0, {0, 0, 0, 0, 1, 0}, true},
    {"deg", degree, {0, 0, 0, 0, 1, 0}, false},
    {"°", degree, {0, 0, 0, 0, 1, 0}, false},
    {"Hz", 1.0, {0, 0, -1, 0, 0, 0}, true},
    {"N", 1.0, {1, 1, -2, 0, 0, 0}, true},
    {"J", 1.0, {2, 1, -2, 0, 0, 0}, true},
    {"W", 1.0, {2, 1, -3, 0, 0, 0}, true},
    {"V", 1.0, {2, 1, -3, -1, 0, 0}, true},
    {"ohm", 1.0, {2, 1, -3, -2, 0, 0}, true},
    {"Ω", 1.0, {2, 1, -3, -2, 0, 0}, true},
    {"H", 1.0, {2, 1, -2, -2, 0, 0}, true},
    {"Pa", 1.0, {-1, 1, -2, 0, 0, 0}, true},
    {"L", 1e-3, {3, 0, 0, 0, 0, 0}, true},
    {"K", 1.0, {0, 0, 0, 0, 0, 0, 1}, true},
    {"min", 60.0, {0, 0, 1, 0, 0, 0}, false},
    {"h", 3600.0, {0, 0, 1, 0, 0, 0}, false},
    {"%", 0.01, {}, false},
    {"1", 1.0, {}, false},
    {"HU", 1.0, {0, 0, 0, 0, 0, 1}, false},
};

struct Prefix {
    std::string_view symbol;
    double factor;
};
constexpr Prefix prefixes[] = {{"k", 1e3},  {"c", 1e-2}, {"m", 1e-3}, {"µ", 1e-6}, {"μ", 1e-6},
                               {"u", 1e-6}, {"n", 1e-9}, {"M", 1e6},  {"G", 1e9}};

std::optional<Unit> find_symbol(std::string_view symbol) {
    for (const Named& unit : named_units)
        if (symbol == unit.symbol) return Unit{unit.factor, {unit.exponent}};
    for (const Prefix& prefix : prefixes) {
        if (!symbol.starts_with(prefix.symbol)) continue;
        const std::string_view rest = symbol.substr(prefix.symbol.size());
        for (const Named& unit : named_units)
            if (unit.prefixed && rest == unit.symbol) return Unit{prefix.factor * unit.factor, {unit.exponent}};
    }
    return std::nullopt;
}

bool eat(std::string_view& text, std::string_view token) {
    if (!text.starts_with(token)) return false;
    text.remove_prefix(token.size());
    return true;
}

int eat_power(std::string_view& text) {
    if (eat(text, "²")) return 2;
    if (eat(text, "³")) return 3;
    if (!eat(text, "^")) return 1;
    int power = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), power);
    if (failure != std::errc{} || std::abs(power) > 9)
        throw Error("the exponent of a unit must be a small integer, as in m^2");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return power;
}

bool at_symbol_end(std::string_view text) {
    for (const std::string_view stop : {" ", "/", "*", "·", "^", "²", "³"})
        if (text.starts_with(stop)) return true;
    return text.empty();
}

void multiply(Unit& into, const Unit& factor, int power) {
    into.factor *= std::pow(factor.factor, power);
    for (std::size_t i = 0; i < Dimension::base_count; ++i) {
        const int sum = into.dimension.exponent[i] + power * factor.dimension.exponent[i];
        if (std::abs(sum) > 100) throw Error("the exponent of the unit is out of range");
        into.dimension.exponent[i] = static_cast<std::int8_t>(sum);
    }
}

std::string_view trim(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

}  // namespace

Unit parse_unit(std::string_view text) {
    Unit unit;
    int sign = 1;
    text = trim(text);
    while (!text.empty()) {
        if (eat(text, " ") || eat(text, "*") || eat(text, "·")) continue;
        if (eat(text, "/")) {
            if (sign < 0) throw Error("two '/' in a row in a unit");
            sign = -1;
            continue;
        }
        std::size_t length = 0;
        while (!at_symbol_end(text.substr(length))) ++length;
        const std::string_view symbol = text.substr(0, length);
        const std::optional<Unit> found = find_symbol(symbol);
        if (!found) throw Error(fmt::format("unknown unit '{}'", symbol.empty() ? text : symbol));
        text.remove_prefix(length);
        multiply(unit, *found, sign * eat_power(text));
        sign = 1;
    }
    if (sign < 0) throw Error("a unit is missing after '/'");
    return unit;
}

Quantity parse_quantity(std::string_view text) {
    text = trim(text);
    const std::string_view whole = text;
    eat(text, "+");
    double number = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc{} || !std::isfinite(number))
        throw Error(fmt::format("'{}' is not a number with a unit", whole));
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const Unit unit = parse_unit(text);
    if (!std::isfinite(number * unit.factor)) throw Error(fmt::format("'{}' is too large", whole));
    return {number * unit.factor, unit.dimension};
}

double parse_as(std::string_view text, std::string_view like) {
    const Quantity quantity = parse_quantity(text);
    if (quantity.dimension == parse_unit(like).dimension) return quantity.value;
    if (like.empty()) throw Error(fmt::format("'{}' has a unit where a bare number is needed", text));
    if (quantity.dimension.is_bare())
        throw Error(fmt::format("'{}' needs a unit, as in \"{} {}\"", text, trim(text), like));
    throw Error(fmt::format("'{}' has the wrong kind of unit; expected one like {}", text, like));
}

std::string format_quantity(double si, std::string_view unit) {
    const double value = si / parse_unit(unit).factor;
    // Twelve digits hide the rounding of the conversion and keep every digit that a user typed.
    return unit.empty() ? fmt::format("{:.12g}", value) : fmt::format("{:.12g} {}", value, unit);
}

}  // namespace tactus
