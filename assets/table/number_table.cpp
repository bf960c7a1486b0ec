// SPDX-License-Identifier: Apache-2.0
#include "assets/table/number_table.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tactus::table {

namespace {

constexpr std::size_t max_cells = 20'000'000;

std::string_view unquoted(std::string_view text) {
    const auto begin = text.find_first_not_of(" \r\"");
    return begin == std::string_view::npos ? std::string_view{}
                                           : text.substr(begin, text.find_last_not_of(" \r\"") - begin + 1);
}

std::vector<std::string_view> cells(std::string_view line, char separator) {
    std::vector<std::string_view> all;
    for (;;) {
        const std::size_t end = line.find(separator);
        all.push_back(unquoted(line.substr(0, end)));
        if (end == std::string_view::npos) return all;
        line.remove_prefix(end + 1);
    }
}

}  // namespace

bool NumberTable::has(std::string_view name) const { return std::ranges::find(names, name) != names.end(); }

void NumberTable::know(const std::vector<std::string>& columns) const {
    for (const std::string& name : names)
        if (std::ranges::find(columns, name) == columns.end())
            throw Error({file, names_line, 1}, fmt::format("unknown column '{}'{}; there may be: {}", name,
                                                           did_you_mean(name, columns), fmt::join(columns, ", ")));
}

const std::vector<std::string>& NumberTable::text(std::string_view name) const {
    const auto at = std::ranges::find(names, name);
    if (at == names.end())
        throw Error({file, 1, 1}, fmt::format("no column '{}'{}; there are: {}", name, did_you_mean(name, names),
                                              fmt::join(names, ", ")));
    return words[static_cast<std::size_t>(at - names.begin())];
}

std::vector<double> NumberTable::numbers(std::string_view name) const {
    std::vector<double> all;
    const std::vector<std::string>& column = text(name);
    for (std::size_t row = 0; row < column.size(); ++row) {
        double value = 0.0;
        const char *begin = column[row].data(), *end = begin + column[row].size();
        const auto [stop, failure] = std::from_chars(begin, end, value);
        if (failure != std::errc{} || stop != end || !std::isfinite(value))
            throw Error({file, lines[row], 1},
                        fmt::format("column '{}' holds '{}', which is not a number", name, column[row]));
        all.push_back(value);
    }
    return all;
}

NumberTable read_number_table(std::string_view text, const std::string& file) {
    NumberTable table;
    table.file = file;
    char separator = ',';
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = unquoted(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++number;
        if (line.empty() || line.front() == '#') continue;
        if (table.names.empty()) {
            for (const char candidate : {';', '\t'})
                if (line.find(candidate) != std::string_view::npos && line.find(',') == std::string_view::npos)
                    separator = candidate;
            table.names_line = number;
            for (const std::string_view name : cells(line, separator)) table.names.emplace_back(name);
            table.words.resize(table.names.size());
            continue;
        }
        const auto row = cells(line, separator);
        if (row.size() != table.names.size())
            throw Error({file, number, 1},
                        fmt::format("the row has {} fields, the header has {}", row.size(), table.names.size()));
        if ((table.rows() + 1) * table.names.size() > max_cells)
            throw Error({file, number, 1}, fmt::format("more than {} fields", max_cells));
        for (std::size_t i = 0; i < row.size(); ++i) table.words[i].emplace_back(row[i]);
        table.lines.push_back(number);
    }
    if (table.names.empty())
        throw Error({file, 1, 1}, "the file is empty; a header line with column names is expected");
    return table;
}

NumberTable load_number_table(const std::filesystem::path& path) {
    return read_number_table(file::read_whole_file(path), path.string());
}

}  // namespace tactus::table
