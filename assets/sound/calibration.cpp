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
#include <vector>

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

/// What follows each `key` and ':' or '=', up to a ';' or the end of the line.
std::vector<std::string> values_of(std::string_view comment, std::string_view key) {
    std::vector<std::string> values;
    const std::string small = lower(comment);
    for (std::size_t at = 0; (at = small.find(key, at)) != std::string::npos; at += key.size()) {
        if (at > 0 && std::isalpha(static_cast<unsigned char>(small[at - 1]))) continue;
        std::size_t from = small.find_first_not_of(" \t", at + key.size());
        if (from == std::string::npos || (small[from] != ':' && small[from] != '=')) continue;
        from = small.find_first_not_of(" \t", from + 1);
        if (from == std::string::npos) continue;
        const std::size_t end = std::min(small.find_first_of(";\r\n", from), small.size());
        values.emplace_back(table::trimmed(comment.substr(from, end - from)));
    }
    return values;
}

/// "fs = 48 kHz" is a sample rate, not a full scale.
bool is_rate_or_time(const Calibration& value) {
    const std::optional<table::ColumnUnit> unit = table::parse_column_unit(value.unit);
    return unit && (unit->is_time() || unit->dimension == parse_unit("Hz").dimension);
}

bool is_same(const Calibration& a, const Calibration& b) {
    return a.is_acceleration == b.is_acceleration &&
           std::abs(a.factor * a.si - b.factor * b.si) <= 1e-6 * std::abs(b.factor * b.si);
}

/// The sensitivity that a comment states; none if it states none. Throws Error if it states several that differ.
std::optional<Sensitivity> stated_sensitivity(std::string_view comment) {
    std::optional<Sensitivity> found;
    for (const std::string& text : values_of(comment, "sensitivity")) {
        // "transverse sensitivity: 5 %" is no volts per unit.
        if (found && text.find('/') == std::string::npos) continue;
        Sensitivity one = parse_sensitivity(text);
        if (found && std::abs(one.volts / one.unit.si - found->volts / found->unit.si) >
                         1e-9 * std::abs(one.volts / one.unit.si))
            throw Error(fmt::format("it states several sensitivities, {} and {}", found->text, one.text));
        found = std::move(one);
    }
    return found;
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
    std::vector<Calibration> usable;
    std::string why;
    for (const std::string_view key : {"fs", "full scale", "full-scale", "fullscale", "calibration"})
        for (const std::string& text : values_of(comment, key)) {
            try {
                Calibration one = parse_calibration(text);
                if (!is_rate_or_time(one)) usable.push_back(std::move(one));
            } catch (const Error& error) {
                if (why.empty()) why = error.message();
            }
        }
    if (usable.empty() && why.empty()) return std::nullopt;
    try {
        if (usable.empty()) throw Error(why);
        Calibration out = usable.front();
        for (const Calibration& other : usable)
            if (!is_same(other, out))
                throw Error(fmt::format("it states several, {:.6g} {} and {:.6g} {}", out.factor, out.unit,
                                        other.factor, other.unit));
        out.source = "the comment of the file";
        if (const auto sensor = stated_sensitivity(comment)) out = through_sensor(out, *sensor);
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
