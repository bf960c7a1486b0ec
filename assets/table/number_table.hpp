// SPDX-License-Identifier: Apache-2.0
// Tables of measurements as text: CSV with a line of names.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

struct NumberTable {
    std::string file;
    std::vector<std::string> names;                ///< of the columns, as written
    std::vector<std::vector<std::string>> words;   ///< per column and row

    std::size_t rows() const { return words.empty() ? 0 : words.front().size(); }
    bool has(std::string_view name) const;
    /// The numbers of a column. Throws Error naming the columns there are, or the line that holds no number.
    std::vector<double> numbers(std::string_view name) const;
    /// The cells of a column as they stand. Throws Error naming the columns there are.
    const std::vector<std::string>& text(std::string_view name) const;

    std::vector<int> lines;  ///< of the file, per row
};

/// Fields are separated by commas, semicolons or tabs, whichever the line of names has; lines that start with '#' are
/// comments. Throws Error with file:line for rows of another length and tables of more than 20 million cells.
NumberTable read_number_table(std::string_view text, const std::string& file);
NumberTable load_number_table(const std::filesystem::path& path);

}  // namespace tactus::table
