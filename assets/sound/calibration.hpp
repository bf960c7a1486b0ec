// SPDX-License-Identifier: Apache-2.0
// What a value in a record is: from an option, from the header of a log, or from the metadata of a sound.
#pragma once

#include "assets/table/column_unit.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace tactus::sound {

/// Calibration: the quantity of a value of 1 in the file (for sound: full scale).
struct Calibration {
    double factor = 1.0;
    std::string unit = "full scale";
    bool known = false;
    /// scale to SI; true when the unit is an acceleration
    double si = 1.0;
    bool is_acceleration = false;
    std::string source;  ///< "the header", "the comment of the file", "the option"; empty: not known
    std::string remark{};  ///< what was not used, and why; empty: nothing
    std::string file_note{};  ///< what is wrong with the header of the sound; empty: nothing
};

/// "9.81 m/s²", "0.02 mm/s", "1 g" (standard gravity). Throws Error naming what is expected.
Calibration parse_calibration(const std::string& text);

/// Calibration in the unit of a log's column.
Calibration calibration_of(const table::ColumnUnit& unit);

/// What a sensor gives: volts per unit of what it measures.
struct Sensitivity {
    double volts = 1.0;      ///< per unit
    table::ColumnUnit unit;  ///< of what it measures
    std::string text;
};

/// "100 mV/g", "10.2 mV/(m/s²)". Throws Error naming what is expected.
Sensitivity parse_sensitivity(const std::string& text);

/// A calibration in volts becomes one in the unit of the sensor. Throws Error for another.
Calibration through_sensor(const Calibration& volts, const Sensitivity& sensitivity);

/// The calibration in the comment of a sound: "calibration: 1 FS = 50 m/s²", also "full scale = 10 V; sensitivity: 100 mV/g".
/// None when it states none; with only a remark when it cannot be understood.
std::optional<Calibration> stated_calibration(std::string_view comment);

/// The comment that states that a value of 1 is one `unit`.
std::string calibration_comment(const std::string& unit);

}  // namespace tactus::sound
