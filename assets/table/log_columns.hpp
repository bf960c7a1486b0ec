// SPDX-License-Identifier: Apache-2.0
// Which columns of a log hold time and the vibration.
#pragma once

#include "assets/table/log_shape.hpp"
#include "assets/table/sample_log.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct LogColumns {
    std::optional<std::size_t> time;  ///< none: the rate is stated
    std::vector<std::size_t> values;
    std::vector<NamedColumn> named;   ///< of all columns: names without units in brackets
    double seconds = 1.0;             ///< of one unit of time
    bool is_unit_stated = true;
    std::string unit = "s";
};

/// `first_row`: its fields. The values are those chosen; else the only other column of numbers; else the axes x, y, z of
/// one sensor, an accelerometer first; else all with the unit of an acceleration, or all when they share a unit. Throws
/// Error.
LogColumns choose_log_columns(const LogShape& shape, const std::vector<std::string_view>& first_row,
                              const std::string& file, const LogSelection& selection);

}  // namespace tactus::table
