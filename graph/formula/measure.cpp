// SPDX-License-Identifier: Apache-2.0
#include "graph/formula/measure.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>

namespace tactus::formula {

namespace {

constexpr int largest = 100 * Measure::whole;

/// Units by which results are named, the first that fits.
constexpr std::string_view known[] = {"m",   "s",  "kg",  "N",     "N/m",     "N s/m",     "m/s",    "m/s^2",
                                      "N m", "Hz", "rad", "rad/s", "N m/rad", "N m s/rad", "W",      "Pa",
                                      "V",   "A",  "K",   "HU",    "m^2",     "m^3",       "kg/m^3", "N/m^2"};
constexpr std::string_view bases[] = {"m", "kg", "s", "A", "rad", "HU", "K"};

std::string power_text(int twelfths) {
    if (twelfths == Measure::whole) return {};
    return fmt::format("^{:.4g}", static_cast<double>(twelfths) / Measure::whole);
}

/// The exponent behind '^', which is taken off `text`; 1 when there is none.
double eat_exponent(std::string_view& text) {
    for (const auto& [token, power] : {std::pair{std::string_view("²"), 2.0}, {std::string_view("³"), 3.0}})
        if (text.starts_with(token)) {
            text.remove_prefix(token.size());
            return power;
        }
    if (!text.starts_with("^")) return 1.0;
    text.remove_prefix(1);
    double exponent = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), exponent);
    if (failure != std::errc{}) throw Error("a number is missing after '^' in a unit");
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return exponent;
}

bool ends_symbol(std::string_view text) {
    for (const std::string_view stop : {" ", "/", "*", "·", "^", "²", "³"})
        if (text.starts_with(stop)) return true;
    return text.empty();
}

}  // namespace

std::string Measure::text() const {
    if (is_bare()) return "a number";
    for (const std::string_view unit : known)
        if (measure_of(parse_unit(unit).dimension) == *this) return std::string(unit);
    std::string above, below;
    for (std::size_t i = 0; i < twelfths.size(); ++i) {
        if (twelfths[i] == 0) continue;
        if (twelfths[i] > 0)
            above += fmt::format("{}{}{}", above.empty() ? "" : " ", bases[i], power_text(twelfths[i]));
        else below += fmt::format("/{}{}", bases[i], power_text(-twelfths[i]));
    }
    return fmt::format("{}{}", above.empty() ? "1" : above, below);
}

Measure measure_of(const Dimension& dimension) {
    Measure measure;
    for (std::size_t i = 0; i < measure.twelfths.size(); ++i)
        measure.twelfths[i] = Measure::whole * dimension.exponent[i];
    return measure;
}

Measure combined(const Measure& a, const Measure& b, int sign) {
    Measure sum = a;
    for (std::size_t i = 0; i < sum.twelfths.size(); ++i) {
        sum.twelfths[i] += sign * b.twelfths[i];
        if (std::abs(sum.twelfths[i]) > largest) throw Error("the exponent of a unit is out of range");
    }
    return sum;
}

std::optional<Measure> raised(const Measure& measure, double exponent) {
    Measure power;
    for (std::size_t i = 0; i < power.twelfths.size(); ++i) {
        const double wanted = measure.twelfths[i] * exponent;
        if (!(std::abs(wanted) <= largest)) return std::nullopt;
        power.twelfths[i] = static_cast<int>(std::lround(wanted));
        if (std::abs(wanted - power.twelfths[i]) > 1e-6) return std::nullopt;
    }
    return power;
}

MeasuredUnit parse_measured_unit(std::string_view text) {
    MeasuredUnit unit;
    int sign = 1;
    while (!text.empty()) {
        if (text.starts_with(" ") || text.starts_with("*")) {
            text.remove_prefix(1);
            continue;
        }
        if (text.starts_with("·")) {
            text.remove_prefix(std::string_view("·").size());
            continue;
        }
        if (text.starts_with("/")) {
            if (sign < 0) throw Error("two '/' in a row in a unit");
            sign = -1;
            text.remove_prefix(1);
            continue;
        }
        std::size_t length = 0;
        while (!ends_symbol(text.substr(length))) ++length;
        if (length == 0) throw Error(fmt::format("unknown unit '{}'", text));
        const Unit factor = parse_unit(text.substr(0, length));
        text.remove_prefix(length);
        const double exponent = eat_exponent(text);
        const auto measure = raised(measure_of(factor.dimension), exponent);
        if (!measure) throw Error("the exponent of a unit must be a small fraction, as in m^1.5");
        unit.factor *= std::pow(factor.factor, sign * exponent);
        unit.measure = combined(unit.measure, *measure, sign);
        sign = 1;
    }
    if (sign < 0) throw Error("a unit is missing after '/'");
    if (!std::isfinite(unit.factor) || unit.factor == 0.0) throw Error("the unit is out of range");
    return unit;
}

}  // namespace tactus::formula
