// SPDX-License-Identifier: Apache-2.0
// Meaning of a value in a record: from an option, from the header of a log, or from the metadata of a sound.
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
    /// Scale of the unit to SI, and whether the unit is an acceleration.
    double si = 1.0;
    bool is_acceleration = false;
    std::string source;  ///< "the header", "the comment of the file", "the option"; empty: unknown
    std::string remark{};  ///< ignored information, and the reason; empty: none
    std::string file_note{};  ///< defect of the sound's header; empty: none
};

/// Parses "9.81 m/s²", "0.02 mm/s", "1 g" (standard gravity). Throws Error with the expected form.
Calibration parse_calibration(const std::string& text);

/// Returns the calibration in the unit of a log's column.
Calibration calibration_of(const table::ColumnUnit& unit);

/// Sensitivity of a sensor: volts per unit of the measured quantity.
struct Sensitivity {
    double volts = 1.0;      ///< per unit
    table::ColumnUnit unit;  ///< of the measured quantity
    std::string text;
};

/// Parses "100 mV/g", "10.2 mV/(m/s²)". Throws Error with the expected form.
Sensitivity parse_sensitivity(const std::string& text);

/// Converts a calibration in volts to the unit of the sensor. Throws Error for another unit.
Calibration through_sensor(const Calibration& volts, const Sensitivity& sensitivity);

/// Returns the calibration in the comment of a sound: "calibration: 1 FS = 50 m/s²", also "full scale = 10 V;
/// sensitivity: 100 mV/g". Nothing if there is none; only a remark if it cannot be parsed.
std::optional<Calibration> stated_calibration(std::string_view comment);

/// Returns the comment for a calibration of one `unit` per value of 1.
std::string calibration_comment(const std::string& unit);

}  // namespace tactus::sound
