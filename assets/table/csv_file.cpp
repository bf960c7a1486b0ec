// SPDX-License-Identifier: Apache-2.0
#include "assets/table/csv_file.hpp"

#include "assets/file/whole_file.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace tactus::table {

namespace {

bool is_negative_zero(std::string_view cell) {
    if (!cell.starts_with("-0")) return false;
    const std::size_t digits = std::min(cell.find_first_not_of("0.", 1), cell.size());
    return digits == cell.size() || cell[digits] == 'e' || cell[digits] == 'E';
}

}  // namespace

std::string with_plain_zeros(std::string csv) {
    std::size_t to = 0;
    bool is_quoted = false;
    for (std::size_t at = 0; at < csv.size();) {
        if (is_quoted || csv[at] == '"') {
            is_quoted ^= csv[at] == '"';
            csv[to++] = csv[at++];
            continue;
        }
        const std::size_t end = std::min(csv.find_first_of(",;\t\r\n\"", at), csv.size());
        const bool has_sign = is_negative_zero(std::string_view(csv).substr(at, end - at));
        for (at += has_sign; at < end; ++at) csv[to++] = csv[at];
        if (at < csv.size() && csv[at] != '"') csv[to++] = csv[at++];
    }
    csv.resize(to);
    return csv;
}

void save_csv(const std::filesystem::path& path, std::string csv) {
    file::write_whole_file(path, with_plain_zeros(std::move(csv)));
}

}  // namespace tactus::table
