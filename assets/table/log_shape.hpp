// SPDX-License-Identifier: Apache-2.0
// Where the table of a log begins, and what separates its fields.
#pragma once

#include "assets/table/stated_sensitivity.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

enum class CellKind {
    number,  ///< with a decimal point or comma, also with a unit behind it: "0.0005 sec"
    time,    ///< a date with a time, or a time of day
    lost,    ///< empty, "nan", "null", …
    word,
};

/// Whether a comma is decimal or groups thousands is not decided here.
CellKind kind_of(std::string_view field);

/// A number with a unit behind it, "0.0005 sec"; none for other text.
struct Measure {
    std::string_view number, unit;
};
std::optional<Measure> split_measure(std::string_view field);

/// A number that a line above the rows states, in SI units.
struct StatedNumber {
    double value = 0.0;
    int line = 0;
    std::string point{};  ///< as written, if its point would group thousands in a file with decimal commas; else empty
};

/// Why a line above the rows cannot be used.
struct HeaderDoubt {
    std::string why;
    int line = 0;
};

struct LogShape {
    char separator = ',';  ///< or no_separator
    int header_line = 0, units_line = 0;  ///< from 1; 0: none
    int first_row = 0;  ///< line of the first row of numbers
    int skipped = 0;  ///< lines above that are neither names, units, comments nor empty
    std::vector<std::string> names;  ///< as written, in UTF-8; "1", "2", … without a header
    std::vector<std::string> units;  ///< of the row of units; as many as names, or none
    std::vector<CellKind> kinds;  ///< of most cells of a column
    std::optional<StatedNumber> rate;  ///< Hz: a sample rate or interval that a line above the rows states
    std::optional<HeaderDoubt> rate_doubt{};  ///< why a stated rate is not used
    bool has_lines = true;  ///< false: of a binary file, whose errors name no line
    std::vector<StatedSensitivity> sensitivities{};  ///< of sensors, as lines above the rows state them
};

/// Looks at the first thousand lines. The table begins at the first rows that look like most: with as many fields, and numbers in
/// the same places. `skip_rows`: lines before the header, which then must be there. Throws Error with file:line.
LogShape find_log_shape(std::string_view text, const std::string& file, std::optional<int> skip_rows);

}  // namespace tactus::table
