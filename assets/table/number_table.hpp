// SPDX-License-Identifier: Apache-2.0
// Tables of measurements: CSV with a header line.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct NumberTable {
    std::string file;
    std::vector<std::string> names;                ///< column names, as written
    std::vector<std::vector<std::string>> words;   ///< per column and row

    std::size_t rows() const { return words.empty() ? 0 : words.front().size(); }
    bool has(std::string_view name) const;
    /// Throws Error for the first column that is not in `columns`, with its line and the name that is meant perhaps.
    void know(const std::vector<std::string>& columns) const;
    /// The numbers of a column. Throws Error with the available columns, or with the line of a cell that is not a
    /// number.
    std::vector<double> numbers(std::string_view name) const;
    /// The cells of a column as text. Throws Error with the available columns.
    const std::vector<std::string>& text(std::string_view name) const;

    int names_line = 1;  ///< line of the names in the file
    std::vector<int> lines;  ///< line in the file, per row
};

/// Reads a table. Fields are separated by commas, semicolons or tabs, as in the header; lines that start with '#' are
/// comments. Throws Error with file:line for rows of another length and for more than 20 million cells.
NumberTable read_number_table(std::string_view text, const std::string& file);
NumberTable load_number_table(const std::filesystem::path& path);

}  // namespace tactus::table
