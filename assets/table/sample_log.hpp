// SPDX-License-Identifier: Apache-2.0
// Logs of samples as text: CSV with a time column, as microcontrollers and data loggers write them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct LogSelection {
    std::string time_column;           ///< name or number from 1; empty: the first whose name speaks of time
    std::vector<std::string> columns;  ///< names or numbers from 1; empty: the only other one, or those named like axes
    std::string time_unit;  ///< "s", "ms", "us" or "ns"; empty: as the column's name ends, else s
};

struct SampleLog {
    std::vector<double> times;  ///< s, never decreasing
    std::vector<std::string> names;  ///< of the chosen columns
    std::vector<std::vector<double>> columns;  ///< values per chosen column, as many as times
    std::string time_name;
    std::size_t lost_rows = 0;  ///< without a number in a chosen column, or cut short at the end
};

/// Fields are separated by commas, semicolons or tabs (whichever the header has most of); lines that start with '#' are
/// comments; the first other line names the columns, or they are called 1, 2, …. With semicolons a number may have a
/// decimal comma. An empty field or "nan" makes a lost row. Throws Error with file:line:column.
SampleLog read_sample_log(std::string_view text, const std::string& file, const LogSelection& selection);

/// The same from a file of at most 4 GiB.
SampleLog load_sample_log(const std::filesystem::path& path, const LogSelection& selection);

}  // namespace tactus::table
