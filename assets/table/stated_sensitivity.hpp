// SPDX-License-Identifier: Apache-2.0
// The sensitivities of sensors that lines above the rows of a log state, and the columns that they are of.
#pragma once

#include "assets/table/column_unit.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct StatedSensitivity {
    std::string text;     ///< "100 mV/g"; empty: none in this place of a list
    std::string channel;  ///< of the line: "x", "channel 1"; empty: none is named
    int line = 0;         ///< from 1
};

/// Those of a line: one in "# x sensitivity: 100 mV/g" and "Sensitivity (mV/g): 100", several in
/// "Sensitivity,100 mV/g,10 mV/g" and "# sensitivity: x = 100 mV/g, y = 10 mV/g". None in other lines.
std::vector<StatedSensitivity> sensitivities_in(std::string_view line, int number, char separator);

struct AssignedSensitivities {
    std::vector<StatedSensitivity> of_columns;  ///< one per chosen column; empty: the file states none
    std::string doubt;  ///< why none can be assigned, and the lines; empty: nothing is stated, or all is clear
};

/// One number for all columns, or one per column: those of a list in order, others by the name, the axis or the number of
/// the channel. `values`: all columns of numbers except times; `chosen`: the columns that need a sensitivity.
AssignedSensitivities assign_sensitivities(std::span<const StatedSensitivity> stated,
                                           const std::vector<NamedColumn>& columns,
                                           const std::vector<std::size_t>& values,
                                           const std::vector<std::size_t>& chosen);

}  // namespace tactus::table
