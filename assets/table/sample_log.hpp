// SPDX-License-Identifier: Apache-2.0
// Sample logs: CSV with a time column, as microcontrollers and data loggers write them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct LogSelection {
    std::string time_column;           ///< name or number from 1; empty: the first whose name indicates time
    std::vector<std::string>
        columns;  ///< names or numbers from 1; empty: the only other column, or those named like axes
    std::string time_unit;  ///< "s", "ms", "us" or "ns"; empty: from the end of the column name, else s
};

struct SampleLog {
    std::vector<double> times;  ///< s, never decreasing
    std::vector<std::string> names;  ///< names of the chosen columns
    std::vector<std::vector<double>> columns;  ///< values per chosen column, as many as times
    std::string time_name;
    std::size_t lost_rows = 0;  ///< rows without a number in a chosen column, or an incomplete last row
};

/// Parses a log. Fields are separated by commas, semicolons or tabs (the most frequent in the header); lines that start
/// with '#' are comments; the first other line names the columns, otherwise they are called 1, 2, …. With semicolons or
/// tabs a number may have a decimal comma; thousands separators, and numbers that could have one, are refused. A row with an empty field or "nan" counts as lost. Throws Error with
/// file:line:column.
SampleLog read_sample_log(std::string_view text, const std::string& file, const LogSelection& selection);

/// The same for a file of at most 4 GiB.
SampleLog load_sample_log(const std::filesystem::path& path, const LogSelection& selection);

}  // namespace tactus::table
