// SPDX-License-Identifier: Apache-2.0
// Units of measured columns, as data loggers write them in headers.
#pragma once

#include "dsp/core/units.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace tactus::table {

struct ColumnUnit {
    std::string text;  ///< as written, without brackets: "g", "m/s²", "mV"
    double si = 1.0;   ///< SI value of one unit
    Dimension dimension;

    bool is_acceleration() const;
    bool is_voltage() const;
    bool is_time() const;
};

/// "g", "m/s2", "m/s²", "m/s^2", "mm/s", "mV", "Volt", "sec", …; g is the standard gravity, 9.80665 m/s², not the gram.
/// None for what is no unit of a measurement.
std::optional<ColumnUnit> parse_column_unit(std::string_view text);

struct NamedColumn {
    std::string name;  ///< without a unit in brackets
    std::optional<ColumnUnit> unit;
};

/// "ax [g]", "Acceleration (m/s²)", "Time / s", "accel_x_mV", "timestamp_ms". A unit after an underscore stays in the
/// name.
NamedColumn parse_column_name(std::string_view header);

/// What the axes of one sensor have in common: "accel" of "accel_x", "gf" of "gFz", "a" of "ay", "" of "Z", in lower
/// case. None when the name ends with no axis.
std::optional<std::string> axis_family(std::string_view name);

}  // namespace tactus::table
