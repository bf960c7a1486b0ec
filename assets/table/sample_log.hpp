// SPDX-License-Identifier: Apache-2.0
// Sample logs: text tables of samples, as microcontrollers, data loggers, oscilloscopes and telephones write them.
#pragma once

#include "assets/table/column_unit.hpp"
#include "assets/table/packed_column.hpp"
#include "assets/table/stated_sensitivity.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct LogSelection {
    std::string time_column;           ///< name or number from 1; empty: the first whose name indicates time
    /// Each a name, a number from 1, or a list of them as names_in() reads it; empty: the only other column, or those
    /// named like axes.
    std::vector<std::string> columns;
    /// Position in a list of names for several files: of each list only this entry, or its last one, is for this file.
    /// The time column is then such a list too. None: all entries are for this file.
    std::optional<std::size_t> list_entry = std::nullopt;
    std::string time_unit;  ///< "s", "ms", "us" or "ns"; empty: from the names, else the only plausible one
    std::optional<int> skip_rows = std::nullopt;  ///< lines before the names; none: found
    std::optional<double> rate = std::nullopt;  ///< Hz: rows follow at this rate, no time column is read
    std::string where{};  ///< "SENSOR=2": only rows with this value in this column; empty: all rows
};

/// The column names in the text of an option. The text is one name if `is_name` accepts it, commas included; otherwise
/// a list separated by commas. Double quotes keep the commas of a name, and "" within them is a quote, as in CSV
/// (RFC 4180): ax,"acc, x (g)". The exact name is tried first, so that a name copied from the file needs no quotes.
std::vector<std::string> names_in(std::string_view text, const std::function<bool(std::string_view)>& is_name);

/// What was understood of the form of a log, so that a wrong guess is seen.
struct LogForm {
    std::string format{};  ///< of files that are no text table: "UFF58, 3 datasets"; empty: what follows counts
    char separator = ',';  ///< '\0': one column
    char decimal = '\0';  ///< '.' or ','; '\0': no number shows it
    int header_line = 0, units_line = 0, first_row = 0;  ///< lines from 1; 0: none
    int skipped = 0;  ///< lines above the rows that were not used, without comments
    int trailer = 0;  ///< lines with statistics below the rows
    std::size_t repeated = 0;  ///< rows that stated the row before once more and were left out
    std::string time;  ///< "column 't' in ms", "clock times in column 'Time'", "--rate, 3200 Hz"
    bool is_time_unit_stated = true;  ///< by an option, a name or the cells; false: the only plausible one

    std::string separator_name() const;  ///< "comma", "semicolon", "tab", "blanks", "none"
    std::string decimal_name() const;  ///< "point", "comma", "none seen"
};

/// One line: "comma-separated, decimal point, names in line 3, units in line 4, first row 5; time: column 't' in ms".
std::string describe(const LogForm& form);

struct SampleLog {
    PackedColumn times;  ///< s, never decreasing; epochs are counted from the whole unit of the first time
    std::vector<std::string> names;  ///< names of the chosen columns, without units in brackets
    std::vector<std::optional<ColumnUnit>> units;  ///< of the chosen columns, as stated in the file
    std::vector<PackedColumn> columns;  ///< values per chosen column, as many as times
    std::string time_name;  ///< empty: no time column
    AssignedSensitivities sensitivities;  ///< of the sensors of the chosen columns, as the file states them
    std::size_t lost_rows = 0;  ///< rows without a number in a chosen column, or an incomplete last row
    LogForm form;
};

/// Parses a log. The table begins at the first rows that look like most of them; the line above names the columns, or the
/// two lines above, names and units. Fields are separated by semicolons, tabs, commas or blanks. Comments begin with '#',
/// '%' or "//". With semicolons, tabs or one column a number may have a decimal comma; thousands separators, and numbers
/// that could have one, are refused. Times are numbers, ISO 8601 or times of day; at midnight a time of day goes on. A
/// row with an empty field or "nan" counts as lost. A unit of time that is neither stated nor named is the only one that
/// makes the rate plausible (`guess_time_unit`); if there is no such unit the log is refused. So is a log that
/// holds several sensors in turn, unless `where` chooses one, or chosen columns with clocks of different rates. Throws Error with file:line:column.
SampleLog read_sample_log(std::string_view text, const std::string& file, const LogSelection& selection);

/// The same for a file: a log of at most 2e9 lines, which is read in blocks: what is in memory are the numbers of the chosen columns. Throws
/// file::NoRoom when those need more than the limit. Universal files (dataset 58) and MATLAB 5 files are detected by their first bytes.
SampleLog load_sample_log(const std::filesystem::path& path, const LogSelection& selection);

}  // namespace tactus::table
