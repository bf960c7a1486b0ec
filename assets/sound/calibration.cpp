// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/calibration.hpp"

#include "assets/table/log_lines.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace tactus::sound {

namespace {

/// A number and a unit, of which parse_quantity knows all but the spellings of headers.
std::pair<double, table::ColumnUnit> parse_measure(const std::string& text) {
    const std::size_t at = text.find_first_not_of("+-0123456789.eE \t");
    if (at != std::string::npos)
        if (auto unit = table::parse_column_unit(std::string_view(text).substr(at)))
            return {parse_quantity(text.substr(0, at)).value, std::move(*unit)};
    const Quantity quantity = parse_quantity(text);
    const std::string unit = at == std::string::npos ? "" : text.substr(at);
    const double si = unit.empty() ? 1.0 : parse_unit(unit).factor;
    return {quantity.value / si, {unit, si, quantity.dimension}};
}

/// What follows `key` and ':' or '=', up to a ';' or the end of the line.
std::optional<std::string> value_of(std::string_view comment, std::string_view key) {
    const std::string small = lower(comment);
    for (std::size_t at = 0; (at = small.find(key, at)) != std::string::npos; at += key.size()) {
        if (at > 0 && std::isalpha(static_cast<unsigned char>(small[at - 1]))) continue;
        std::size_t from = small.find_first_not_of(" \t", at + key.size());
        if (from == std::string::npos || (small[from] != ':' && small[from] != '=')) continue;
        from = small.find_first_not_of(" \t", from + 1);
        if (from == std::string::npos) continue;
        const std::size_t end = std::min(small.find_first_of(";\r\n", from), small.size());
        return std::string(table::trimmed(comment.substr(from, end - from)));
    }
    return std::nullopt;
}

}  // namespace

Calibration calibration_of(const table::ColumnUnit& unit) {
    return {1.0, unit.text, true, unit.si, unit.is_acceleration(), {}, {}};
}

Calibration parse_calibration(const std::string& text) {
    try {
        const auto [factor, unit] = parse_measure(text);
        Calibration out = calibration_of(unit);
        out.factor = factor;
        if (out.unit.empty() || !(std::abs(factor) > 0.0) || !std::isfinite(factor))
            throw Error(fmt::format(
                "a calibration must be a quantity other than 0 with its unit, such as \"9.81 m/s^2\", not '{}'", text));
        return out;
    } catch (const Error& error) {
        if (error.message().starts_with("a calibration")) throw;
        throw Error(fmt::format("a calibration must be a quantity such as \"9.81 m/s^2\": {}", error.message()));
    }
}

Sensitivity parse_sensitivity(const std::string& text) {
    const auto refuse = [&text]() -> Error {
        return Error(fmt::format("a sensitivity must be volts per unit, such as \"100 mV/g\", not '{}'", text));
    };
    const std::size_t slash = text.find('/');
    if (slash == std::string::npos) throw refuse();
    const std::optional<table::ColumnUnit> unit = table::parse_column_unit(std::string_view(text).substr(slash + 1));
    if (!unit) throw refuse();
    try {
        const auto [number, volts] = parse_measure(std::string(table::trimmed(text.substr(0, slash))));
        const Sensitivity out{number * volts.si, *unit, text};
        if (!volts.is_voltage() || !(std::abs(out.volts) > 0.0) || !std::isfinite(out.volts)) throw refuse();
        return out;
    } catch (const Error&) {
        throw refuse();
    }
}

Calibration through_sensor(const Calibration& volts, const Sensitivity& sensitivity) {
    const std::optional<table::ColumnUnit> unit =
        volts.known ? table::parse_column_unit(volts.unit) : std::optional<table::ColumnUnit>();
    if (!unit || !unit->is_voltage())
        throw Error(
            fmt::format("a sensitivity needs a record in volts, and this one is in {}; state what a value of 1 "
                        "is, as --calibration \"1 mV\" (sound: what full scale is)",
                        volts.unit));
    Calibration out = calibration_of(sensitivity.unit);
    out.factor = volts.factor * volts.si / sensitivity.volts;
    out.source = fmt::format("{} and the sensitivity {}", volts.source, sensitivity.text);
    out.remark = volts.remark;
    return out;
}

std::optional<Calibration> stated_calibration(std::string_view comment) {
    std::optional<std::string> text;
    for (const std::string_view key : {"fs", "full scale", "full-scale", "fullscale", "calibration"})
        if (!text) text = value_of(comment, key);
    if (!text) return std::nullopt;
    try {
        Calibration out = parse_calibration(*text);
        out.source = "the comment of the file";
        if (const auto sensor = value_of(comment, "sensitivity")) out = through_sensor(out, parse_sensitivity(*sensor));
        return out;
    } catch (const Error& error) {
        Calibration unknown;
        unknown.remark =
            fmt::format("the comment of the file states a calibration that is not used: {}", error.message());
        return unknown;
    }
}

std::string calibration_comment(const std::string& unit) { return "calibration: 1 FS = 1 " + unit; }

}  // namespace tactus::sound
