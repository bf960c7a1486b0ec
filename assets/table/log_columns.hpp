// SPDX-License-Identifier: Apache-2.0
// Which columns of a log hold time and the vibration.
#pragma once

#include "assets/table/log_shape.hpp"
#include "assets/table/sample_log.hpp"
#include "assets/table/time_unit.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct LogColumns {
    std::optional<std::size_t> time;  ///< none: the rate is stated
    double rate = 0.0;                ///< Hz, as stated by the option or the file; 0: there is a time column
    std::vector<std::size_t> values;
    std::vector<std::size_t> clocks;  ///< columns of times that the values follow, when those are several
    std::vector<std::size_t> sources; ///< columns that may say which of several sensors a row is from
    std::optional<std::size_t> where; ///< column of the selected rows
    std::string wanted;               ///< its value
    std::vector<NamedColumn> named;   ///< of all columns: names without units in brackets
    std::optional<TimeUnit> unit;     ///< of numbers in the column of times; none: neither stated nor named
};

/// `first_row`: its fields. The values are those chosen; else the only other column of numbers; else the axes x, y, z of
/// one sensor, an accelerometer first; else all with the unit of an acceleration, or all when they share a unit. Throws
/// Error.
LogColumns choose_log_columns(const LogShape& shape, const std::vector<std::string_view>& first_row,
                              const std::string& file, const LogSelection& selection);

/// True for names such as "SENSOR", "device id" and "I", of columns that say which sensor a row is from.
bool is_source_name(std::string_view name);

}  // namespace tactus::table
